# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads ARS408 clusters back from a candump log, by the interface document."""
import collections
import dataclasses


@dataclasses.dataclass
class LoggedScan:
    stamp_us: int
    counter: int
    count: int
    general: list = dataclasses.field(default_factory=list)  # Payloads.
    quality: list = dataclasses.field(default_factory=list)


def frames(path):
    for line in path.read_text().splitlines():
        stamp, interface, frame = line.split()
        seconds, micros = stamp.strip("()").split(".")
        number, payload = frame.split("#")
        yield int(seconds) * 1_000_000 + int(micros), interface, int(number, 16), bytes.fromhex(payload)


def scans(path):
    """{interface: [LoggedScan]}"""
    found = collections.defaultdict(list)
    for stamp_us, interface, number, payload in frames(path):
        if number == 0x600:
            found[interface].append(LoggedScan(stamp_us, payload[2] << 8 | payload[3], payload[0] + payload[1]))
        elif number == 0x701:
            found[interface][-1].general.append(payload)
        elif number == 0x702:
            found[interface][-1].quality.append(payload)
    return found


def decoded(general, quality):
    """Values by the names of nuScenes' fields."""
    assert general[0] == quality[0]
    return {"id": general[0], "x": (general[1] << 5 | general[2] >> 3) * 0.2 - 500.0,
            "y": ((general[2] & 3) << 8 | general[3]) * 0.2 - 102.3,
            "vx": (general[4] << 2 | general[5] >> 6) * 0.25 - 128.0,
            "vy": ((general[5] & 63) << 3 | general[6] >> 5) * 0.25 - 64.0,
            "dyn_prop": general[6] & 7, "rcs": general[7] * 0.5 - 64.0,
            "x_rms": quality[1] >> 3, "y_rms": (quality[1] & 7) << 2 | quality[2] >> 6,
            "vx_rms": quality[2] >> 1 & 31, "vy_rms": (quality[2] & 1) << 4 | quality[3] >> 4,
            "pdh0": quality[3] & 7, "invalid_state": quality[4] >> 3, "ambig_state": quality[4] & 7}
