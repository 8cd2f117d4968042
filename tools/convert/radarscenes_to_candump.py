# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Converts sequences of RadarScenes to drives.

Its radars are not ARS408s: they report range, azimuth and radial velocity, without noise or motion flags.
The frames have them on the grid of the ARS408, with noise from the stated resolution
(radar-scenes.com/dataset/sensors), zero velocity across and DynProp "unknown"."""
import json
import math
import pathlib

import drive_folder
from ars408_log import Cluster, Losses, Scan, carried, rms_code

UNKNOWN = 4  # DynProp.
# One sigma is assumed to be the resolution, plus the rounding to the grid.
RANGE_STD_M = math.hypot(0.15, 0.2 / math.sqrt(12.0))
DOPPLER_STD_MPS = math.hypot(0.1 / 3.6, 0.25 / math.sqrt(12.0))
AZIMUTH_STD_RAD = (math.radians(0.5), math.radians(2.0))  # At boresight, at the edge of the view.
VIEW_RAD = math.radians(60.0)
# Tolerances of check_conventions.
MOST_POSITION_ERROR_M = 0.1
MOST_SPEED_ERROR_MPS = 0.3

HEADING = """# {name} of RadarScenes, made by cremed-convert. cremed.toml explains the keys.
#
# These radars are not ARS408s: the frames have their targets on a grid of 0.2 m and 0.25 m/s, with noise
# from the stated resolution (0.15 m, 0.5 to 2 degrees, 0.1 km/h). There are no motion flags, so all targets
# are kept, and no velocities across, so there is no rotation lead; azimuths
# have no known scale.
"""
SETTINGS = """keep_dyn_props = [4]
calibration.rotation_lead_s = 0.0
calibration.azimuth_scale = 1.0
"""


def h5py():
    try:
        import h5py as module  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise ValueError("RadarScenes is in HDF5 files; install python3-h5py") from error
    return module


def sequences_of(folder, names):
    """Folder with sensors.json (`folder` or its data), and names of sequences."""
    folder = pathlib.Path(folder)
    root = next((path for path in (folder, folder / "data") if (path / "sensors.json").exists()), None)
    if root is None:
        raise ValueError(f"{folder}: has no sensors.json or data/sensors.json; must be RadarScenes' folder")
    known = sorted((path.parent.name for path in root.glob("*/radar_data.h5")),
                   key=lambda name: (len(name), name))
    if not known:
        raise ValueError(f"{root}: has no */radar_data.h5; must be RadarScenes' folder with its sequences")
    for name in names:
        if name not in known:
            raise ValueError(f"--scene: there is no {name}; there are {', '.join(known)}")
    return root, names or known


def read_json(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise ValueError(f"{path}: {error}") from error


def columns(table, names, path):
    missing = [name for name in names if name not in (table.dtype.names or ())]
    if missing:
        raise ValueError(f"{path}: {table.name.strip('/')} has no column {missing[0]}; is it of RadarScenes?")
    rows = table[:]
    return [rows[name].tolist() for name in names]


def read_tables(path):
    """Detections and odometry, each a list of tuples."""
    with h5py().File(path, "r") as file:
        for name in ("radar_data", "odometry"):
            if name not in file:
                raise ValueError(f"{path}: has no data set {name}; is it of RadarScenes?")
        detections = columns(file["radar_data"], ("range_sc", "azimuth_sc", "rcs", "vr", "vr_compensated",
                                                  "x_cc", "y_cc"), path)
        odometry = columns(file["odometry"], ("timestamp", "x_seq", "y_seq", "yaw_seq", "vx", "yaw_rate"), path)
    return list(zip(*detections)), list(zip(*odometry))


def rms_of(range_m, azimuth_rad):
    """Codes of x, y, vx, vy."""
    at_boresight, at_edge = AZIMUTH_STD_RAD
    share = min(abs(azimuth_rad) / VIEW_RAD, 1.0)
    across_m = range_m * (at_boresight + share * (at_edge - at_boresight))
    cosine, sine = math.cos(azimuth_rad), math.sin(azimuth_rad)
    doppler = rms_code(DOPPLER_STD_MPS)
    return (rms_code(math.hypot(cosine * RANGE_STD_M, sine * across_m)),
            rms_code(math.hypot(sine * RANGE_STD_M, cosine * across_m)), doppler, doppler)


def cluster_of(number, detection):
    range_m, azimuth_rad, rcs_dbm2, doppler_mps = detection[:4]
    cosine, sine = math.cos(azimuth_rad), math.sin(azimuth_rad)
    return Cluster(number, range_m * cosine, range_m * sine, doppler_mps * cosine, doppler_mps * sine,
                   rcs_dbm2, UNKNOWN, rms_of(range_m, azimuth_rad))


def check_conventions(path, mount, detections, odometry):
    """Checks the signs of azimuth (counter-clockwise) and velocity (negative when closing) with other columns
    of the file."""
    _, _, _, _, speed_mps, yaw_rate_radps = odometry
    for range_m, azimuth_rad, _, doppler_mps, static_mps, x_m, y_m in detections:
        bearing = azimuth_rad + mount["yaw"]
        error_m = math.hypot(mount["x"] + range_m * math.cos(bearing) - x_m,
                             mount["y"] + range_m * math.sin(bearing) - y_m)
        expected_mps = (-(speed_mps - yaw_rate_radps * mount["y"]) * math.cos(bearing)
                        - yaw_rate_radps * mount["x"] * math.sin(bearing))
        if error_m > MOST_POSITION_ERROR_M:
            raise ValueError(f"{path}: azimuth_sc and x_cc, y_cc contradict each other by {error_m:.1f} m")
        if abs(doppler_mps - static_mps - expected_mps) > MOST_SPEED_ERROR_MPS + 0.05 * abs(speed_mps):
            raise ValueError(f"{path}: vr, vr_compensated and odometry contradict each other by "
                             f"{abs(doppler_mps - static_mps - expected_mps):.1f} m/s")


def drive_of(folder, mounts, progress, losses):
    path = folder / "radar_data.h5"
    detections, odometry = read_tables(path)
    radars = {mount["id"]: drive_folder.Radar(name, f"can{number}", mount["x"], mount["y"], mount["yaw"], [])
              for number, (name, mount) in enumerate(sorted(mounts.items()))}
    by_id = {mount["id"]: mount for mount in mounts.values()}
    scenes = read_json(folder / "scenes.json")["scenes"]
    for done, (stamp, scene) in enumerate(sorted(scenes.items(), key=lambda item: int(item[0]))):
        begin, end = scene["radar_indices"]
        if end > len(detections) or scene["sensor_id"] not in radars:
            raise ValueError(f"{folder / 'scenes.json'}: scene {stamp} is not of radar_data.h5 and sensors.json")
        found, radar = detections[begin:end], radars[scene["sensor_id"]]
        if done % 50 == 0:
            check_conventions(path, by_id[scene["sensor_id"]], found, odometry[scene["odometry_index"]])
        clusters = [cluster_of(number, one) for number, one in enumerate(found)]
        radar.scans.append(Scan(radar.interface, int(stamp), carried(clusters, losses)))
        progress.advance()
    return drive_folder.Drive(folder.name, HEADING.format(name=folder.name), SETTINGS,
                              [radar for radar in radars.values() if radar.scans],
                              [row[:4] for row in odometry])


def convert(folder, output, names):
    """Converts the named sequences, without names all."""
    h5py()
    root, names = sequences_of(folder, names)
    mounts = read_json(root / "sensors.json")
    total = sum(len(read_json(root / name / "scenes.json")["scenes"]) for name in names)
    with drive_folder.Progress("radarscenes", total) as progress:
        for name in names:
            losses = Losses()
            drive_folder.write(drive_of(root / name, mounts, progress, losses), output, losses, progress)
