# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What an LCM log of cremed tells of a drive, as columns: an hour of it is a million messages."""
import itertools
import os
import struct
import types
from array import array

import cremed
from thinning import evenly
from timeline import Timeline

# Targets of a report: more than that, and scans are left out, evenly over the drive.
TARGETS = 120_000
ODOMETRY_COLUMNS = ("utime", "status", "x", "y", "yaw", "cov_xx", "cov_xy", "cov_yy", "vx", "sigma_vx",
                    "vy", "yaw_rate", "sigma_yaw_rate")
SCAN = cremed.radar_scan_t._get_packed_fingerprint()  # pylint: disable=protected-access


def odometry_row(m):
    pose, twist = (m.covariance_x_y_yaw_in_odom_frame_m_rad,
                   m.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps)
    return (m.utime, m.status, m.x_in_odom_frame_m, m.y_in_odom_frame_m, m.yaw_in_odom_frame_rad,
            pose[0], pose[1], pose[4], m.vx_in_vehicle_frame_mps, max(twist[0], 0.0) ** 0.5,
            m.vy_in_vehicle_frame_mps, m.yaw_rate_radps, max(twist[8], 0.0) ** 0.5)


class HeardDrive:
    """`told` is called with the part that is done, now and then. Times are those of its timeline; 0 if it has none
    and `may_be_silent`."""

    def __init__(self, path, told=lambda part: None, may_be_silent=False):
        self.path, self.told, self.may_be_silent = path, told, may_be_silent
        self.size = max(os.path.getsize(path), 1)
        self.odometry = {name: array("d") for name in ODOMETRY_COLUMNS}
        self.motions = {}   # Source: (times, statuses).
        self.statuses = {}  # Radar: the fields of its messages, one a second.
        self.scan_places, self.targets = {}, 0  # Channel: (times, begins of the payloads, ends).
        self.damage, self.others = None, cremed.OtherVersions()
        self.timeline = Timeline(self._move)
        self._read()
        self.begin_us, self.end_us = self._span()

    def _read(self):
        takers = {"CREMED_ODOMETRY": self._take_odometry, "CREMED_EGO_MOTION": self._take_motion,
                  "CREMED_STATUS": self._take_status}
        with open(self.path, "rb", cremed.listener.READ_BYTES) as log:
            try:
                for number, (channel, _, payload, end) in enumerate(cremed.events_in(log)):
                    if number % 4096 == 0:
                        self.told(end / self.size)
                    if channel in takers:
                        heard = cremed.decoded(channel, 0, payload)
                        if heard is None:
                            self.others.add(channel)
                        # A status from before the first frame has no time.
                        if heard is not None and heard.message.utime != 0:
                            self._take(takers[channel], heard.message)
                    elif channel.startswith("CREMED_SCAN_"):
                        self._note_scan(channel, payload, end)
            except cremed.DamagedLog as damage:
                self.damage = damage

    def _take(self, taker, message):
        stream = type(message), getattr(message, "source", "")
        message.utime = self.timeline.joined(stream, message.utime, message.seq)
        taker(message)

    def _move(self, since, by):
        """Changes the times of what was taken last."""
        columns = [self.odometry["utime"], *(times for times, *_ in self.motions.values()),
                   *(times for times, *_ in self.scan_places.values())]
        for times in columns:
            for i in last_since(times, since):
                times[i] += by
        for messages in self.statuses.values():
            for i in last_since([message.utime for message in messages], since):
                messages[i].utime += by

    def _note_scan(self, channel, payload, end):
        try:
            utime, seq, counter = head_of_scan(payload)
        except struct.error:  # Cut off, or of another version.
            return
        times, begins, ends = self.scan_places.setdefault(channel, (array("q"), array("q"), array("q")))
        times.append(self.timeline.joined(channel, utime, seq))
        begins.append(end - len(payload))
        ends.append(end)
        self.targets += len(payload) // 31  # Bytes of a target.
        self.timeline.note_cycle(channel, utime, counter)

    def troubles(self):
        """What keeps the report from being whole."""
        found = [str(trouble) for trouble in (self.damage, self.others.text(self.path)) if trouble]
        if not self.odometry["utime"]:
            found.append(f"{self.path}: has no odometry on CREMED_ODOMETRY")
        return found

    def _take_odometry(self, message):
        for column, value in zip(self.odometry.values(), odometry_row(message)):
            column.append(value)

    def _take_motion(self, message):
        times, statuses = self.motions.setdefault(message.source, (array("q"), array("b")))
        times.append(message.utime)
        statuses.append(message.status)

    def _take_status(self, message):
        fields = types.SimpleNamespace(**cremed.fields_of(message), run=self.timeline.runs)
        self.statuses.setdefault(message.source, []).append(fields)
        self.timeline.note_clock_steps(fields.clock_steps)

    def _span(self):
        columns = [self.odometry["utime"], *(times for times, _ in self.motions.values())]
        ends = [time for column in columns if column for time in (column[0], column[-1])]
        # Of a drive in which all radars were silent there are statuses.
        ends = ends or [message.utime for messages in self.statuses.values() for message in messages]
        if not ends and self.may_be_silent:
            return 0, 0
        if not ends:
            raise self.damage or ValueError(
                self.others.text(self.path)
                or f"{self.path}: has none of cremed's messages; record with lcm-logger, or give the candump log")
        return int(min(ends)), int(max(ends))

    def scans(self):
        """[radar_scan_t], as many as a report holds."""
        count = max((len(times) for times, _, _ in self.scan_places.values()), default=0)
        count = max(count * min(1, TARGETS / max(self.targets, 1)), 1)
        wanted = sorted((begins[i], ends[i], times[i]) for times, begins, ends in self.scan_places.values()
                        for i in evenly(times, self.begin_us, self.end_us, int(count)))
        with open(self.path, "rb") as log:
            for begin, end, utime in wanted:
                log.seek(begin)
                heard = cremed.decoded("", 0, log.read(end - begin))
                if heard is not None:
                    heard.message.utime = utime
                    yield heard.message


def last_since(times, since):
    """Indices, from the last on."""
    return itertools.takewhile(lambda i: times[i] >= since, reversed(range(len(times))))


def head_of_scan(payload):
    """(utime, seq, counter) of a radar_scan_t; the counter stands behind its source's name and its status."""
    fingerprint, utime, seq, length = struct.unpack_from(">8sqqi", payload)
    if fingerprint != SCAN:
        raise struct.error("another type")
    return utime, seq, struct.unpack_from(">i", payload, 29 + length)[0]
