# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Converts scenes of nuScenes to drives.

Fields, units and frames as in the schema of the data set: poses are those of the rear axle's centre, clusters
are in the radar's frame, with velocities, states and rms codes of the ARS408."""
import collections
import json
import math
import pathlib
import re
import struct

import drive_folder
from ars408_log import RMS_INVALID, Cluster, Losses, Scan, carried

TABLES = ("scene", "log", "sample", "sample_data", "calibrated_sensor", "sensor", "ego_pose")
RADARS = {"RADAR_FRONT": ("front", "can0"), "RADAR_FRONT_LEFT": ("left", "can1"),
          "RADAR_FRONT_RIGHT": ("right", "can2"), "RADAR_BACK_LEFT": ("rear_left", "can3"),
          "RADAR_BACK_RIGHT": ("rear_right", "can4")}
PCD_FORM = {"FIELDS": "x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms "
                      "y_rms invalid_state pdh0 vx_rms vy_rms",
            "SIZE": "4 4 4 1 2 4 4 4 4 4 1 1 1 1 1 1 1 1",
            "TYPE": "F F F I I F F F F F I I I I I I I I",
            "COUNT": " ".join(["1"] * 18),
            "DATA": "binary"}
POINT = struct.Struct("<fffbhfffffbbbbbbbb")
Point = collections.namedtuple("Point", PCD_FORM["FIELDS"])

HEADING = """# Scene {name} of nuScenes (vehicle {vehicle}, {location}), made by cremed-convert.
#
# Mounts are those of the data set; config/nuscenes-*.toml have calibrated yaws for the same cars, with
# lower errors. cremed.toml explains the keys, config/nuscenes-*.toml their values. The log has the
# velocities across the line of sight as sent by the sensor, so rotation_lead_s has its default.
"""
SETTINGS = """keep_invalid_states = [0, 4, 8, 9, 10, 11, 12, 15, 16, 17]
keep_dyn_props = [1, 3, 5]
calibration.doppler_scale = 1.005
calibration.azimuth_std_factor = 0.7
"""


def rows(path):
    """Reads a table row by row: those of the whole data set are gigabytes."""
    decode, separator, text = json.JSONDecoder().raw_decode, re.compile(r"[\[,\s]*"), ""
    with open(path, encoding="utf-8") as file:
        for chunk in iter(lambda: file.read(1 << 20), ""):
            text, at = text + chunk, 0
            while True:
                begin = separator.match(text, at).end()
                try:
                    row, at = decode(text, begin)
                except json.JSONDecodeError:
                    break
                yield row
            text = text[at:]
    if text.strip("[ \r\n\t") != "]":
        raise ValueError(f"{path}: is no JSON table, or ends early")


def tables_of(folder):
    """Folder of the tables, and the base of the file names in them."""
    folder = pathlib.Path(folder)
    if (folder / "sample_data.json").exists():
        found = folder
    else:
        versions = sorted(path.parent for path in folder.glob("v1.0-*/sample_data.json"))
        if not versions:
            raise ValueError(f"{folder}: has no v1.0-*/sample_data.json; must be nuScenes' folder, with its "
                             "tables in v1.0-mini or v1.0-trainval and samples and sweeps beside it")
        if len(versions) > 1:
            names = " or ".join(str(path) for path in versions)
            raise ValueError(f"{folder}: has several versions; must be {names}")
        found = versions[0]
    for table in TABLES:
        if not (found / f"{table}.json").exists():
            raise ValueError(f"{found}: has no {table}.json; unpack nuScenes' metadata there again")
    return found, found.parent


def yaw_of(rotation):
    w, x, y, z = rotation
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def pcd_header(path, data):
    """{"POINTS": "125", ...} and where the points begin."""
    end = re.search(rb"^DATA [^\n]*\n", data, re.MULTILINE)
    if not end:
        raise ValueError(f"{path}: is no PCD file: it has no line that begins with DATA")
    lines = data[:end.end()].decode("ascii", errors="replace").splitlines()
    return dict(line.split(maxsplit=1) for line in lines if " " in line), end.end()


def read_points(path):
    data = pathlib.Path(path).read_bytes()
    head, begin = pcd_header(path, data)
    for key, form in PCD_FORM.items():
        if head.get(key, "").strip() != form:
            raise ValueError(f"{path}: {key} is '{head.get(key, '')}'; must be '{form}', as in nuScenes' "
                             "radar files")
    size = int(head.get("POINTS", "0")) * POINT.size
    if len(data) < begin + size:
        raise ValueError(f"{path}: ends after {len(data)} bytes; must have {begin + size} for its POINTS")
    points = [Point._make(values) for values in POINT.iter_unpack(data[begin:begin + size])]
    return [] if points and math.isnan(points[0].x) else points  # NaN marks an empty cloud.


def cluster_of(point, path):
    rms = (point.x_rms, point.y_rms, point.vx_rms, point.vy_rms)
    codes = ((point.dyn_prop, 7), (point.pdh0, 7), (point.invalid_state, 31), (point.ambig_state, 7),
             *((code, 31) for code in rms))
    if not all(0 <= code <= most for code, most in codes):
        raise ValueError(f"{path}: has a state or rms that is no code of an ARS408")
    return Cluster(point.id, point.x, point.y, point.vx, point.vy, point.rcs, point.dyn_prop,
                   rms if point.is_quality_valid else (RMS_INVALID,) * 4, point.pdh0, point.invalid_state,
                   point.ambig_state)


class DataSet:
    """The rows of the tables that radars need."""

    def __init__(self, folder, names):
        self.folder, self.root = tables_of(folder)
        scenes = {row["token"]: row for row in self.rows("scene")}
        known = {row["name"] for row in scenes.values()}
        for name in names:
            if name not in known:
                raise ValueError(f"--scene: there is no {name}; there are {', '.join(sorted(known))}")
        self.names = set(names)
        self.scenes = {token: row for token, row in scenes.items() if not names or row["name"] in names}
        self.logs = {row["token"]: row for row in self.rows("log")}
        self.sweeps = collections.defaultdict(list)  # Of a scene: (channel, row of sample_data).
        self.read_sweeps()
        self.read_poses()

    def rows(self, table):
        return rows(self.folder / f"{table}.json")

    def read_sweeps(self):
        channels = {row["token"]: row["channel"] for row in self.rows("sensor") if row["channel"] in RADARS}
        self.mounts = {row["token"]: row for row in self.rows("calibrated_sensor")
                       if row["sensor_token"] in channels}
        samples = {row["token"]: row["scene_token"] for row in self.rows("sample")
                   if row["scene_token"] in self.scenes}
        for row in self.rows("sample_data"):
            mount, scene = self.mounts.get(row["calibrated_sensor_token"]), samples.get(row["sample_token"])
            if mount and scene:
                self.sweeps[scene].append((channels[mount["sensor_token"]], row))

    def read_poses(self):
        wanted = {row["ego_pose_token"] for sweeps in self.sweeps.values() for _, row in sweeps}
        self.poses = {row["token"]: (row["timestamp"], *row["translation"][:2], yaw_of(row["rotation"]))
                      for row in self.rows("ego_pose") if row["token"] in wanted}
        if len(self.poses) < len(wanted):
            raise ValueError(f"{self.folder / 'ego_pose.json'}: has no row for {len(wanted) - len(self.poses)} "
                             "sweeps of radars; sample_data.json is of another version")

    def missing(self, scene):
        """A missing file of the scene, if any: the whole data set comes in parts."""
        paths = (self.root / row["filename"] for _, row in self.sweeps[scene])
        return next((path for path in paths if not path.exists()), None)

    def there(self):
        """Scenes whose files are all present."""
        scenes = []
        for token, row in sorted(self.scenes.items(), key=lambda item: item[1]["name"]):
            missing = self.missing(token) if self.sweeps[token] else "any sweep of a radar"
            if missing is None:
                scenes.append(token)
            elif self.names:
                raise ValueError(f"{row['name']}: {missing} is missing; unpack nuScenes' files with radars "
                                 "(v1.0-*_blobs) beside its tables")
        if not scenes:
            raise ValueError(f"{self.root}: has the radars' files of no scene; unpack nuScenes' files with "
                             "radars (v1.0-*_blobs) beside its tables")
        return scenes

    def drive(self, scene, progress, losses):
        row, radars = self.scenes[scene], []
        for channel, (name, interface) in RADARS.items():
            sweeps = sorted((one for kind, one in self.sweeps[scene] if kind == channel),
                            key=lambda one: one["timestamp"])
            if not sweeps:
                continue
            mount = self.mounts[sweeps[0]["calibrated_sensor_token"]]
            x_m, y_m = mount["translation"][:2]
            scans = []
            for sweep in sweeps:
                path = self.root / sweep["filename"]
                clusters = [cluster_of(point, path) for point in read_points(path)]
                scans.append(Scan(interface, sweep["timestamp"], carried(clusters, losses)))
                progress.advance()
            radars.append(drive_folder.Radar(name, interface, x_m, y_m, yaw_of(mount["rotation"]), scans))
        truth = [self.poses[sweep["ego_pose_token"]] for _, sweep in self.sweeps[scene]]
        log = self.logs.get(row["log_token"], {})
        heading = HEADING.format(name=row["name"], vehicle=log.get("vehicle", "unknown"),
                                 location=log.get("location", "unknown"))
        return drive_folder.Drive(row["name"], heading, SETTINGS, radars, truth)


def convert(folder, output, names):
    """Converts the named scenes, without names all."""
    data = DataSet(folder, names)
    scenes = data.there()
    with drive_folder.Progress("nuscenes", sum(len(data.sweeps[scene]) for scene in scenes)) as progress:
        for scene in scenes:
            losses = Losses()
            drive_folder.write(data.drive(scene, progress, losses), output, losses, progress)
    if len(scenes) < len(data.scenes):
        print(f"{len(data.scenes) - len(scenes)} scenes were left out: files of their radars are missing")
