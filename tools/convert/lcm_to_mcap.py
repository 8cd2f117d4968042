# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""An LCM log of cremed as MCAP."""
import contextlib
import json
import math
import re
import sys

import cremed
from foxglove_messages import SCHEMAS, drawn
from mcap_writer import McapWriter
from replaced_file import replaced_file
from scene import RadarFrames

# Those of several sources become a topic a source.
TOPICS = {cremed.odometry_t: "CREMED_ODOMETRY", cremed.ego_motion_t: "CREMED_EGO_MOTION",
          cremed.status_t: "CREMED_STATUS", cremed.radar_scan_t: "CREMED_SCAN"}
LATEST_US = (1 << 63) // 1000  # MCAP counts nanoseconds.
JSON_TYPES = {bool: "boolean", int: "integer", float: "number", str: "string"}
STATUS_NAMES = {kind: cremed.names_of(kind, "STATUS_") for kind in TOPICS}
# Fields with a value a target.
OF_TARGETS = {kind: [name for name, value in cremed.fields_of(kind()).items() if value == []] for kind in TOPICS}


def schema_of(kind):
    """A number that is NaN, "none", is left out of a message: JSON has no NaN."""
    properties = {}
    for name, value in cremed.fields_of(kind()).items():
        if isinstance(value, list) and value:
            properties[name] = {"type": "array", "items": {"type": JSON_TYPES[type(value[0])]}}
        elif name not in OF_TARGETS[kind]:
            properties[name] = {"type": JSON_TYPES[type(value)]}
    if STATUS_NAMES[kind]:
        properties["status_name"] = {"type": "string"}
    return f"cremed.{kind.__name__}", {"type": "object", "properties": properties}


def is_number(value):
    values = value if isinstance(value, (list, tuple)) else [value]
    return not any(isinstance(one, float) and not math.isfinite(one) for one in values)


def encoded(content):
    return json.dumps(content, allow_nan=False).encode()


def as_json(message):
    """Without the targets, which are drawn as points."""
    values = cremed.fields_of(message)
    if STATUS_NAMES[type(message)]:
        values["status_name"] = STATUS_NAMES[type(message)].get(message.status, "unknown")
    return {name: list(value) if isinstance(value, tuple) else value
            for name, value in values.items() if is_number(value) and name not in OF_TARGETS[type(message)]}


def topic_of(message):
    """Which also becomes the name of a file: a name of a damaged log, or of another's, may hold a path."""
    source = re.sub(r"[^\w-]", "_", getattr(message, "source", ""))
    return TOPICS[type(message)] + (f"_{source.upper()}" if source else "")


class JsonProfile:
    """All fields of all messages but the lists of targets, and what Foxglove draws of them: (topic, type, bytes) of a message."""
    name, encoding, schema_encoding = "", "json", "jsonschema"
    missing = ""  # What is not in the log.

    def __init__(self):
        self.frames = RadarFrames()

    @staticmethod
    def left_out():
        return ""

    @staticmethod
    def schema(kind):
        name, schema = (kind, SCHEMAS[kind]) if kind in SCHEMAS else schema_of(kind)
        return name, json.dumps(schema)

    def records(self, message):
        records = [(topic_of(message), type(message), encoded(as_json(message)))]
        with contextlib.suppress(ValueError):  # Of a damaged log: a pose that is not finite is not drawn.
            records += [(topic, kind, encoded(content)) for topic, kind, content in drawn(message, self.frames)]
        return records


def each_once(heard_messages):
    """What is published on the channel for all, and on that of the source, is one message."""
    last = {}
    for heard in heard_messages:
        message = heard.message
        stream, key = (type(message), getattr(message, "source", "")), (message.utime, message.seq)
        is_dated = message.utime != 0 or not isinstance(message, cremed.status_t)  # That from before the first frame.
        if is_dated and 0 <= message.utime < LATEST_US and last.get(stream) != key:
            last[stream] = key
            yield heard


def write_messages(log, writer, profile):
    """How many; and what is wrong with the log, of which all before that is written: None, if nothing.
    The time of a message is that of its measurement: a log of a replay has the drive's pace. The time of
    recording is the time of publication."""
    count = 0
    try:
        for heard in each_once(cremed.read_log(log)):
            message = heard.message
            published_us = min(max(heard.received_us, 0), LATEST_US)  # Of a damaged log it may be anything.
            for topic, kind, content in profile.records(message):
                writer.add(topic, kind, message.seq, message.utime * 1000, published_us * 1000, content)
                count += 1
    except cremed.DamagedLog as damage:
        return count, damage
    return count, ValueError(f"{log}: {profile.left_out()}") if profile.left_out() else None


def convert(log, out, library, profile):
    """Raises, after it has converted what comes before damage, where there is any."""
    with replaced_file(out) as file:
        writer = McapWriter(file, library, profile)
        count, damage = write_messages(log, writer, profile)
        if count == 0:
            raise damage or ValueError(f"{log}: has none of cremed's messages; record with lcm-logger")
        writer.finish()
    if profile.missing and not profile.left_out():
        print(f"cremed-convert: {log}: {profile.missing}", file=sys.stderr)
    if damage:
        raise damage
