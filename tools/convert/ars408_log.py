# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes clusters of ARS408s as CAN frames, in candump's format."""
import dataclasses
import heapq
import math

FRAME_US = 250  # 8 bytes at 500 kbit/s.
SECOND_US = 1_000_000
COUNTER_STEP = 2  # Of MeasCounter, per cycle.
MOST_CLUSTERS = 250
# Constant, once a second: configured to clusters with quality, told speed and yaw rate, no fault; version 4.30.2.
STATE_FRAMES = ((0x201, bytes.fromhex("4019000010180000")), (0x700, bytes.fromhex("041E0200")))

RMS_INVALID = 31


def rms_code(std):
    """Smallest code whose bound (m, m/s) is at least `std`."""
    return min(max(math.ceil(30 * math.log(std / 0.005) / math.log(2000) - 1e-9), 0), 30)


@dataclasses.dataclass
class Cluster:
    """Content of messages 0x701 and 0x702; rms and states are the sensor's codes."""
    id: int
    x_m: float
    y_m: float
    vx_mps: float
    vy_mps: float
    rcs_dbm2: float
    dyn_prop: int
    rms: tuple  # x, y, vx, vy
    false_alarm: int = 0
    invalid_state: int = 0
    ambiguity: int = 3


@dataclasses.dataclass
class Scan:
    interface: str
    stamp_us: int
    clusters: list
    cycle: int = 0  # Number since the begin of the log; missing scans count.
    spacing_us: int = FRAME_US


@dataclasses.dataclass
class Losses:
    """Counts of scans and of what the frames cannot represent."""
    scans: int = 0
    clusters: int = 0
    rounded: int = 0   # Not on the grid of the messages (0.2 m, 0.25 m/s, 0.5 dB).
    left_out: int = 0  # Outside the range of the messages (y +-102 m, vx +-128 m/s, vy +-64 m/s), or too many.

    def __str__(self):
        return (f"{self.scans} scans, {self.clusters} clusters, {self.rounded} of them rounded; "
                f"{self.left_out} left out")


class Grid:
    """Unsigned integer of `bits` bits with scale `step` and offset `least`."""

    def __init__(self, step, least, bits):
        self.step, self.least, self.most = step, least, (1 << bits) - 1

    def raw(self, value):
        return round((value - self.least) / self.step)

    def holds(self, value):
        return 0 <= self.raw(value) <= self.most

    def rounds(self, value):
        return abs(value - self.least - self.step * self.raw(value)) > 0.05 * self.step


X, Y = Grid(0.2, -500.0, 13), Grid(0.2, -102.3, 10)
VX, VY = Grid(0.25, -128.0, 10), Grid(0.25, -64.0, 9)
RCS = Grid(0.5, -64.0, 8)


def values(cluster):
    return ((X, cluster.x_m), (Y, cluster.y_m), (VX, cluster.vx_mps), (VY, cluster.vy_mps))


def carried(clusters, losses):
    """Clusters within the range of the messages; if too many, the nearest."""
    fit = [cluster for cluster in clusters
           if all(math.isfinite(value) and grid.holds(value) for grid, value in values(cluster))]
    if len(fit) > MOST_CLUSTERS:
        nearest = sorted(fit, key=lambda one: math.hypot(one.x_m, one.y_m))[:MOST_CLUSTERS]
        kept = {id(one) for one in nearest}
        fit = [one for one in fit if id(one) in kept]
    losses.scans += 1
    losses.clusters += len(fit)
    losses.left_out += len(clusters) - len(fit)
    losses.rounded += sum(any(grid.rounds(value) for grid, value in values(one)) for one in fit)
    ids = [one.id for one in fit]
    if len(set(ids)) < len(ids) or not all(0 <= one <= 255 for one in ids):
        fit = [dataclasses.replace(one, id=number) for number, one in enumerate(fit)]
    return fit


def general(cluster):
    x, y, vx, vy = (grid.raw(value) for grid, value in values(cluster))
    rcs = min(max(RCS.raw(cluster.rcs_dbm2), 0), RCS.most)
    return bytes((cluster.id, x >> 5, (x << 3 | y >> 8) & 255, y & 255, vx >> 2,
                  (vx << 6 | vy >> 3) & 255, (vy << 5 | cluster.dyn_prop) & 255, rcs))


def quality(cluster):
    x, y, vx, vy = cluster.rms
    return bytes((cluster.id, x << 3 | y >> 2, (y << 6 | vx << 1 | vy >> 4) & 255,
                  (vy << 4 | cluster.false_alarm) & 255, cluster.invalid_state << 3 | cluster.ambiguity))


def header(scan):
    counter = COUNTER_STEP * scan.cycle & 0xFFFF
    return bytes((len(scan.clusters), 0, counter >> 8, counter & 255, 0x10))


def number_cycles(scans):
    """Numbers the scans of one radar, with gaps for missing scans, and spaces their frames so that each list
    ends before the next scan."""
    gaps = [later.stamp_us - scan.stamp_us for scan, later in zip(scans, scans[1:])]
    if any(gap <= 0 for gap in gaps):
        raise ValueError(f"stamps of {scans[0].interface} do not increase")
    cycle_us = sorted(gaps)[len(gaps) // 2] if gaps else SECOND_US
    for scan, later, gap in zip(scans, scans[1:], gaps):
        later.cycle = scan.cycle + max(1, round(gap / cycle_us))
        scan.spacing_us = min(FRAME_US, gap * 9 // 10 // (2 * len(scan.clusters) + 1))


def scan_frames(scans):
    """(stamp, interface, identifier, payload) of one radar's scans: header, all 0x701, all 0x702."""
    for scan in scans:
        frames = [(0x600, header(scan)), *((0x701, general(one)) for one in scan.clusters),
                  *((0x702, quality(one)) for one in scan.clusters)]
        for number, (identifier, payload) in enumerate(frames):
            yield scan.stamp_us + number * scan.spacing_us, scan.interface, identifier, payload


def state_frames(scans):
    for stamp_us in range(scans[0].stamp_us, scans[-1].stamp_us, SECOND_US):
        for identifier, payload in STATE_FRAMES:
            yield stamp_us, scans[0].interface, identifier, payload


def write_log(file, radars):
    """`radars`: scans per radar, in the order of their stamps."""
    sources = []
    for scans in filter(None, radars):
        number_cycles(scans)
        sources += [state_frames(scans), scan_frames(scans)]
    for stamp_us, interface, identifier, payload in heapq.merge(*sources, key=lambda frame: frame[0]):
        file.write(f"({stamp_us // SECOND_US}.{stamp_us % SECOND_US:06d}) {interface} "
                   f"{identifier:03X}#{payload.hex().upper()}\n")
