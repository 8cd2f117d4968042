# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Receives cremed's LCM messages with the build's Python module; needs no route."""
import importlib
import pathlib
import sys
import threading
import time
import types
from dataclasses import dataclass


def cremed_module():
    """The build's module: a test's first argument is the folder of the build or of its programs."""
    for build in (pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[1]).parent):
        folder = build / "lcm_types" / "python"
        if folder.is_dir():
            sys.path.insert(0, str(folder))
            return importlib.import_module("cremed")
    raise FileNotFoundError(f"no lcm_types/python in the build of {sys.argv[1]}")


CHANNELS = ("CREMED_EGO_MOTION", "CREMED_ODOMETRY", "CREMED_SCAN_FRONT", "CREMED_STATUS")


@dataclass
class Heard:
    """A message and its time of arrival; monotonic_s: of reading."""
    wall_us: int
    monotonic_s: float
    message: object

    @property
    def age_s(self):
        return (self.wall_us - self.message.utime) * 1e-6


class LcmListener(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.heard = {channel: [] for channel in CHANNELS}
        # By address, to receive on lo with any routes.
        self.listener = cremed_module().Listener(interface="127.0.0.1")
        self.start()

    def run(self):
        for heard in self.listener:
            if heard.channel in self.heard:
                self.heard[heard.channel].append(Heard(heard.received_us, time.monotonic(),
                                                       heard.message))

    def motions(self, source, since_s=0.0):
        """Motions of a radar received after a time of time.monotonic()."""
        return [heard for heard in list(self.heard["CREMED_EGO_MOTION"])
                if heard.message.source == source and heard.monotonic_s > since_s]

    def estimates(self, source, since_s=0.0):
        return [heard for heard in self.motions(source, since_s) if heard.message.status in (0, 1)]

    def motions_of_scans(self, source, since_us):
        """Motions of scans that began after a time of time.time_ns() / 1000."""
        return [heard for heard in self.motions(source) if heard.message.utime > since_us]

    def statuses(self, source, since_s=0.0):
        """Their fields, as attributes."""
        fields_of = cremed_module().fields_of
        return [types.SimpleNamespace(**fields_of(heard.message))
                for heard in list(self.heard["CREMED_STATUS"])
                if heard.message.source == source and heard.monotonic_s > since_s]

    def status(self, source):
        """The latest status."""
        return self.statuses(source)[-1]
