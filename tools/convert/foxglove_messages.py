# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed's messages as those that Foxglove's 3D panel draws (docs.foxglove.dev/docs/sdk/schemas): of their fields
those that are required, as in schemas/jsonschema of github.com/foxglove/foxglove-sdk."""
import base64
import math

import cremed
from scene import BASE, ODOM, POINT, POINT_FIELDS, USABLE, mount_of, points_of, pose_of

NUMERIC_TYPES = {"B": 1, "H": 3, "f": 7}
INTEGER, NUMBER, STRING = ({"type": name} for name in ("integer", "number", "string"))


def record_of(**properties):
    return {"type": "object", "properties": properties}


TIME = record_of(sec=INTEGER, nsec=INTEGER) | {"title": "time"}
VECTOR = record_of(x=NUMBER, y=NUMBER, z=NUMBER)
QUATERNION = record_of(x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
POSE = record_of(position=VECTOR, orientation=QUATERNION)
FIELDS = {"type": "array", "items": record_of(name=STRING, offset=INTEGER, type=INTEGER)}
SCHEMAS = {
    "foxglove.PoseInFrame": record_of(timestamp=TIME, frame_id=STRING, pose=POSE),
    "foxglove.FrameTransform": record_of(timestamp=TIME, parent_frame_id=STRING, child_frame_id=STRING,
                                         translation=VECTOR, rotation=QUATERNION),
    "foxglove.PointCloud": record_of(timestamp=TIME, frame_id=STRING, pose=POSE, point_stride=INTEGER, fields=FIELDS,
                                     data=STRING | {"contentEncoding": "base64"}),
}


def in_space(x, y, yaw):
    """Position and orientation."""
    return {"x": x, "y": y, "z": 0.0}, {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def of_odometry(message, timestamp):
    position, orientation = in_space(*pose_of(message))
    yield "/odom", "foxglove.PoseInFrame", {
        "timestamp": timestamp, "frame_id": ODOM, "pose": {"position": position, "orientation": orientation}}
    yield "/tf", "foxglove.FrameTransform", {
        "timestamp": timestamp, "parent_frame_id": ODOM, "child_frame_id": BASE, "translation": position,
        "rotation": orientation}


def of_scan(message, timestamp, frames):
    """In base_link, from where the radar is mounted."""
    position, orientation = in_space(*mount_of(message))
    yield f"/{frames.of(message.source)}/points", "foxglove.PointCloud", {
        "timestamp": timestamp, "frame_id": BASE, "pose": {"position": position, "orientation": orientation},
        "point_stride": POINT.size, "data": base64.b64encode(points_of(message)).decode(),
        "fields": [{"name": name, "offset": offset, "type": NUMERIC_TYPES[kind]} for name, offset, kind in POINT_FIELDS]}


def drawn(message, frames):
    """(topic, schema, content) of what is drawn of a message."""
    timestamp = {"sec": message.utime // 1_000_000, "nsec": message.utime % 1_000_000 * 1000}
    if isinstance(message, cremed.odometry_t) and message.status in USABLE:
        yield from of_odometry(message, timestamp)
    elif isinstance(message, cremed.radar_scan_t):
        yield from of_scan(message, timestamp, frames)
