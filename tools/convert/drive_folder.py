# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a converted drive: a folder with can.log, truth.csv and cremed.toml."""
import contextlib
import dataclasses
import io
import pathlib
import sys

import ars408_log
from replaced_file import replaced_file


@dataclasses.dataclass
class Radar:
    name: str
    interface: str
    x_m: float
    y_m: float
    yaw_rad: float
    scans: list


@dataclasses.dataclass
class Drive:
    name: str
    heading: str   # Comments at the begin of the configuration.
    settings: str  # TOML keys of each radar.
    radars: list
    truth: list    # (utime, x, y, yaw)


def radar_table(radar, settings):
    return (f'\n[[radar]]\nname = "{radar.name}"\ntype = "ars408"\ninterface = "{radar.interface}"\n'
            f"mount = {{ x_m = {radar.x_m:.6g}, y_m = {radar.y_m:.6g}, yaw_rad = {radar.yaw_rad:.9g} }}\n"
            f"{settings}")


def write_configuration(file, drive):
    file.write(f"{drive.heading}\n[output]\n"
               'lcm_url = "none"  # for recorded drives; --lcm-url overrides it\n')
    for radar in drive.radars:
        file.write(radar_table(radar, drive.settings))


def write_truth(file, poses):
    """One row per time, in order."""
    file.write("utime,x_m,y_m,yaw_rad\n")
    for utime, (x_m, y_m, yaw_rad) in sorted({pose[0]: pose[1:] for pose in poses}.items()):
        file.write(f"{utime},{x_m:.6f},{y_m:.6f},{yaw_rad:.9f}\n")


def write(drive, output, losses, progress):
    """Files appear in the folder only when all are complete. Tells what was written."""
    folder = pathlib.Path(output) / drive.name
    folder.mkdir(parents=True, exist_ok=True)
    parts = {"can.log": lambda file: ars408_log.write_log(file, [radar.scans for radar in drive.radars]),
             "truth.csv": lambda file: write_truth(file, drive.truth),
             "cremed.toml": lambda file: write_configuration(file, drive)}
    with contextlib.ExitStack() as files:
        for name, write_part in parts.items():
            text = io.TextIOWrapper(files.enter_context(replaced_file(folder / name)), encoding="utf-8")
            write_part(text)
            text.detach()
    progress.wipe()
    print(f"{drive.name}: {len(drive.radars)} radars, {losses} -> {folder}")


class Progress:
    """A progress bar on standard error, if that is a terminal."""
    WIDTH = 40

    def __init__(self, label, total):
        self.label, self.total, self.done, self.shown = label, max(total, 1), 0, -1

    def advance(self):
        self.done += 1
        percent = 100 * self.done // self.total
        if percent != self.shown and sys.stderr.isatty():
            bar = "#" * (self.WIDTH * self.done // self.total)
            print(f"\r{self.label:<20} [{bar:<{self.WIDTH}}] {percent:3d} %", end="", file=sys.stderr,
                  flush=True)
        self.shown = percent

    def wipe(self):
        self.shown = -1
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.wipe()
