# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a small folder in nuScenes' official form from a simulated drive of five ARS408."""
import bisect
import json
import math
import struct

from candump_scans import decoded, scans

FIELDS = ("x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms y_rms "
          "invalid_state pdh0 vx_rms vy_rms").split()
CHANNELS = {"can0": "RADAR_FRONT", "can1": "RADAR_FRONT_LEFT", "can2": "RADAR_FRONT_RIGHT",
            "can3": "RADAR_BACK_LEFT", "can4": "RADAR_BACK_RIGHT"}
HEADER = """# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS {fields}
SIZE 4 4 4 1 2 4 4 4 4 4 1 1 1 1 1 1 1 1
TYPE F F F I I F F F F F I I I I I I I I
COUNT 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1
WIDTH {count}
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS {count}
DATA binary
"""


def pcd(points):
    """Dictionaries by field; one that is absent is 0, the quality is valid."""
    header = HEADER.format(fields=" ".join(FIELDS), count=len(points)).encode()
    return header + b"".join(
        struct.pack("<fffbhfffffbbbbbbbb", *({"is_quality_valid": 1, **point}.get(name, 0) for name in FIELDS))
        for point in points)


def points_of(scan):
    """An empty cloud is one point of NaN."""
    points = [decoded(general, quality) for general, quality in zip(scan.general, scan.quality)]
    return points or [{"x": math.nan, "y": math.nan}]


class Truth:
    def __init__(self, path):
        rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
        self.times = [int(row[0]) for row in rows]
        self.poses = [tuple(map(float, row[1:])) for row in rows]

    def at(self, stamp_us):
        after = min(max(bisect.bisect_left(self.times, stamp_us), 1), len(self.times) - 1)
        begin, end = self.times[after - 1], self.times[after]
        share = (stamp_us - begin) / (end - begin)
        return tuple(a + share * (b - a) for a, b in zip(self.poses[after - 1], self.poses[after]))


def rotation(yaw_rad):
    return [math.cos(yaw_rad / 2.0), 0.0, 0.0, math.sin(yaw_rad / 2.0)]


class Folder:
    """`mounts`: {interface: (x, y, yaw)}; the drive is cut into two scenes at `cut_us`."""

    def __init__(self, root, log, truth, mounts, cut_us):
        self.root, self.truth, self.cut_us = root, truth, cut_us
        self.tables = {name: [] for name in ("scene", "log", "sample", "sample_data", "calibrated_sensor",
                                             "sensor", "ego_pose", "category")}
        self.tables["log"].append({"token": "log", "vehicle": "n008", "location": "boston-seaport"})
        for number in (1, 2):
            self.tables["scene"].append({"token": f"s{number}", "name": f"scene-000{number}", "log_token": "log"})
            self.tables["sample"].append({"token": f"sample{number}", "scene_token": f"s{number}",
                                          "timestamp": cut_us})
        self.add_lidar()
        for interface, mount in mounts.items():
            self.add_radar(interface, mount, scans(log)[interface])
        self.tables["sample_data"].reverse()  # Their order means nothing.
        self.write()

    def add_sensor(self, channel, modality, mount):
        x_m, y_m, yaw_rad = mount
        self.tables["sensor"].append({"token": channel, "channel": channel, "modality": modality})
        self.tables["calibrated_sensor"].append(
            {"token": f"c-{channel}", "sensor_token": channel, "translation": [x_m, y_m, 0.5],
             "rotation": rotation(yaw_rad), "camera_intrinsic": []})

    def add_data(self, channel, stamp_us, path):
        token = f"{channel}-{stamp_us}"
        x_m, y_m, yaw_rad = self.truth.at(stamp_us)
        self.tables["ego_pose"].append({"token": token, "timestamp": stamp_us, "translation": [x_m, y_m, 0.0],
                                        "rotation": rotation(yaw_rad)})
        self.tables["sample_data"].append(
            {"token": token, "sample_token": f"sample{1 if stamp_us < self.cut_us else 2}",
             "ego_pose_token": token, "calibrated_sensor_token": f"c-{channel}", "timestamp": stamp_us,
             "fileformat": "pcd", "is_key_frame": False, "filename": path, "prev": "", "next": ""})

    def add_lidar(self):
        self.add_sensor("LIDAR_TOP", "lidar", (0.9, 0.0, -1.57))
        self.add_data("LIDAR_TOP", self.cut_us, "samples/LIDAR_TOP/none.pcd.bin")

    def add_radar(self, interface, mount, found):
        channel = CHANNELS[interface]
        self.add_sensor(channel, "radar", mount)
        for number, scan in enumerate(found):
            path = f"{'samples' if number % 6 == 0 else 'sweeps'}/{channel}/n008__{scan.stamp_us}.pcd"
            (self.root / path).parent.mkdir(parents=True, exist_ok=True)
            (self.root / path).write_bytes(pcd(points_of(scan)))
            self.add_data(channel, scan.stamp_us, path)

    def write(self):
        version = self.root / "v1.0-mini"
        version.mkdir(exist_ok=True)
        for name, rows in self.tables.items():
            (version / f"{name}.json").write_text(json.dumps(rows, indent=0))
