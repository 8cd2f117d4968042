# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Messages of ROS 2 as bytes: CDR of the OMG, little-endian, as their definitions lay them out."""
import re
import struct

LITTLE_ENDIAN_CDR = bytes([0, 1, 0, 0])
# Layout and size; a value is aligned to its size.
NUMBERS = {"bool": ("?", 1), "byte": ("B", 1), "char": ("B", 1), "int8": ("b", 1), "uint8": ("B", 1),
           "int16": ("h", 2), "uint16": ("H", 2), "int32": ("i", 4), "uint32": ("I", 4), "int64": ("q", 8),
           "uint64": ("Q", 8), "float32": ("f", 4), "float64": ("d", 8)}
FIELD = re.compile(r"(?P<kind>[A-Za-z][\w/]*)(?P<array>\[(?P<count>\d*)\])? (?P<name>\w+)$")


class Definitions:
    """{"std_msgs/Header": "builtin_interfaces/Time stamp\\nstring frame_id\\n", ...}: of each its fields;
    types of other messages are named in full."""

    def __init__(self, texts):
        self.texts = texts
        self.fields = {name: [FIELD.match(line).groupdict() for line in text.splitlines() if "=" not in line]
                       for name, text in texts.items()}

    def schema(self, name):
        """The text that MCAP calls ros2msg: the definition, and below it those of all parts."""
        parts = self._parts(name, [])
        rule = "=" * 80
        return self.texts[name] + "".join(f"{rule}\nMSG: {part}\n{self.texts[part]}" for part in parts)

    def _parts(self, name, found):
        for field in self.fields[name]:
            if field["kind"] in self.texts and field["kind"] not in found:
                found.append(field["kind"])
                self._parts(field["kind"], found)
        return found

    def encode(self, name, message):
        """`message`: a value a field, a dictionary for a message. A field that is left out is 0 or empty."""
        data = bytearray()
        self._add_message(data, name, message)
        return LITTLE_ENDIAN_CDR + bytes(data)

    def _add_message(self, data, name, message):
        unknown = set(message) - {field["name"] for field in self.fields[name]}
        assert not unknown, (name, unknown)
        for field in self.fields[name]:
            value = message.get(field["name"])
            if field["array"]:
                self._add_array(data, field, value)
            else:
                self._add(data, field["kind"], value)

    def _add_array(self, data, field, values):
        count = int(field["count"] or 0)
        values = [0] * count if values is None and count else values or b""
        assert count in (0, len(values)), field
        if not count:
            self._add(data, "uint32", len(values))
        if field["kind"] in NUMBERS:
            layout, size = NUMBERS[field["kind"]]
            if values:
                align(data, size)
            data += bytes(values) if size == 1 else struct.pack(f"<{len(values)}{layout}", *values)
        else:
            for value in values:
                self._add(data, field["kind"], value)

    def _add(self, data, kind, value):
        if kind in NUMBERS:
            layout, size = NUMBERS[kind]
            align(data, size)
            data += struct.pack(f"<{layout}", value or 0)
        elif kind == "string":
            text = (value or "").encode() + b"\0"
            self._add(data, "uint32", len(text))
            data += text
        else:
            self._add_message(data, kind, value or {})


def align(data, size):
    data += bytes(-len(data) % size)
