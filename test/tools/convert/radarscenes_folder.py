# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a small folder in RadarScenes' official form: a car drives a bend among posts. Needs h5py."""
import json
import math
import random

import h5py
import numpy

MOUNTS = {"radar_1": {"id": 1, "x": 3.663, "y": -0.873, "yaw": -1.484},
          "radar_2": {"id": 2, "x": 3.86, "y": -0.7, "yaw": -0.436},
          "radar_3": {"id": 3, "x": 3.86, "y": 0.7, "yaw": 0.436},
          "radar_4": {"id": 4, "x": 3.663, "y": 0.873, "yaw": 1.484}}
DETECTION = [("timestamp", "i8"), ("sensor_id", "u1"), ("range_sc", "f4"), ("azimuth_sc", "f4"), ("rcs", "f4"),
             ("vr", "f4"), ("vr_compensated", "f4"), ("x_cc", "f4"), ("y_cc", "f4"), ("x_seq", "f4"),
             ("y_seq", "f4"), ("uuid", "S32"), ("track_id", "S32"), ("label_id", "u1")]
ODOMETRY = [("timestamp", "i8"), ("x_seq", "f4"), ("y_seq", "f4"), ("yaw_seq", "f4"), ("vx", "f4"),
            ("yaw_rate", "f4")]
BEGIN_US = 156_862_647_501
STEP_US = 15_000  # From one radar to the next.
SPEED_MPS, YAW_RATE_RADPS = 8.0, 0.15


def pose(time_s):
    yaw_rad = YAW_RATE_RADPS * time_s
    radius_m = SPEED_MPS / YAW_RATE_RADPS
    return radius_m * math.sin(yaw_rad), radius_m * (1.0 - math.cos(yaw_rad)), yaw_rad


def seen(post, mount, time_s):
    """(range, azimuth, vr, x_cc, y_cc) of a fixed post."""
    x_m, y_m, yaw_rad = pose(time_s)
    dx, dy = post[0] - x_m, post[1] - y_m
    x_cc = math.cos(yaw_rad) * dx + math.sin(yaw_rad) * dy
    y_cc = -math.sin(yaw_rad) * dx + math.cos(yaw_rad) * dy
    bearing = math.atan2(y_cc - mount["y"], x_cc - mount["x"])
    vx, vy = SPEED_MPS - YAW_RATE_RADPS * mount["y"], YAW_RATE_RADPS * mount["x"]
    azimuth = math.remainder(bearing - mount["yaw"], 2.0 * math.pi)
    return (math.hypot(x_cc - mount["x"], y_cc - mount["y"]), azimuth,
            -(vx * math.cos(bearing) + vy * math.sin(bearing)), x_cc, y_cc)


def write(root, seconds=3.0, crowded_scene=8):
    """One sequence; in one scene a radar sees 300 more. Returns {radar's name: [(stamp, [(range, azimuth,
    vr)])]}."""
    draw = random.Random(3)
    posts = [(draw.uniform(-60.0, 80.0), draw.uniform(-60.0, 80.0)) for _ in range(500)]
    rows, odometry, scenes, told = [], [], {}, {name: [] for name in MOUNTS}
    for step in range(int(seconds * 1e6) // STEP_US):
        name, stamp, time_s = sorted(MOUNTS)[step % 4], BEGIN_US + step * STEP_US, step * STEP_US * 1e-6
        begin = len(rows)
        extra = [(draw.uniform(-60.0, 80.0), draw.uniform(-60.0, 80.0)) for _ in range(1000)]
        for post in posts + (extra if step == crowded_scene else []):
            range_m, azimuth, vr, x_cc, y_cc = seen(post, MOUNTS[name], time_s)
            if range_m < 100.0 and abs(azimuth) < math.radians(60.0):
                rows.append((stamp, MOUNTS[name]["id"], range_m, azimuth, 3.0, vr, 0.0, x_cc, y_cc, *post, b"",
                             b"", 11))
        odometry.append((stamp, *pose(time_s), SPEED_MPS, YAW_RATE_RADPS))
        scenes[str(stamp)] = {"sensor_id": MOUNTS[name]["id"], "odometry_timestamp": stamp,
                              "odometry_index": step, "radar_indices": [begin, len(rows)], "image_name": ""}
        told[name].append((stamp, [row[2:4] + (row[5],) for row in rows[begin:]]))
    folder = root / "data" / "sequence_1"
    folder.mkdir(parents=True)
    (root / "data" / "sensors.json").write_text(json.dumps(MOUNTS))
    (folder / "scenes.json").write_text(json.dumps({"category": "train", "scenes": scenes}))
    with h5py.File(folder / "radar_data.h5", "w") as file:
        file["radar_data"] = numpy.array(rows, dtype=DETECTION)
        file["odometry"] = numpy.array(odometry, dtype=ODOMETRY)
    return told
