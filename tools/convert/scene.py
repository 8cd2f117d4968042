# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn of cremed's messages, in any format: poses in the frames of REP 105 (odom, base_link, which is
the centre of the rear axle, and one a radar), and targets as packed points."""
import itertools
import math
import re
import struct

import cremed

ODOM, BASE = "odom", "base_link"
# odometry_t.STATUS_* with which there is a pose.
USABLE = (cremed.odometry_t.STATUS_OK, cremed.odometry_t.STATUS_STANDING_STILL,
          cremed.odometry_t.STATUS_PREDICTED)
POINT = struct.Struct("<8fHBx")
# Name, offset, and type as struct has it.
POINT_FIELDS = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("doppler_mps", 12, "f"), ("rcs_dbm2", 16, "f"),
                ("range_std_m", 20, "f"), ("azimuth_std_rad", 24, "f"), ("doppler_std_mps", 28, "f"),
                ("id", 32, "H"), ("validity", 34, "B")]


def points_of(scan):
    """In the radar's frame."""
    targets = zip(scan.range_m, scan.azimuth_rad, scan.doppler_mps, scan.rcs_dbm2, scan.range_std_m,
                  scan.azimuth_std_rad, scan.doppler_std_mps, scan.id, scan.validity)
    return b"".join(POINT.pack(length * math.cos(azimuth), length * math.sin(azimuth), 0.0, *others[:-2],
                               others[-2] & 0xFFFF, others[-1] & 0xFF)
                    for length, azimuth, *others in targets)


def pose_of(message):
    """x, y, yaw in odom."""
    return message.x_in_odom_frame_m, message.y_in_odom_frame_m, message.yaw_in_odom_frame_rad


def mount_of(scan):
    """x, y, yaw in base_link."""
    return (scan.mount_x_in_vehicle_frame_m, scan.mount_y_in_vehicle_frame_m,
            scan.mount_yaw_in_vehicle_frame_rad)


class RadarFrames:
    """Of what a topic of ROS may have; names that are the same in that get a number."""

    def __init__(self):
        self.frames = {}

    def of(self, radar):
        if radar not in self.frames:
            name = "radar_" + re.sub(r"\W", "_", radar.lower(), flags=re.ASCII)
            numbered = (f"{name}_{number}" for number in itertools.count(2))
            self.frames[radar] = next(one for one in itertools.chain([name], numbered) if one not in self.frames.values())
        return self.frames[radar]
