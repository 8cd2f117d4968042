# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Hears what cremed publishes over LCM; needs lcm-gen, but neither LCM's library nor a route."""
import importlib
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass

GROUP, PORT = "239.255.76.67", 7667
ROOT = pathlib.Path(__file__).resolve().parents[2]


def message_types():
    """CREMED_EGO_MOTION's and CREMED_STATUS's classes, generated from the project's definitions."""
    folder = tempfile.mkdtemp(prefix="lcm-types-")
    types = [ROOT / "lcm_types" / "cremed" / f"{name}.lcm" for name in ("ego_motion_t", "status_t")]
    subprocess.run(["lcm-gen", "--python", "--ppath", folder, *types], check=True)
    sys.path.insert(0, folder)
    package = importlib.import_module("cremed")
    return {"CREMED_EGO_MOTION": package.ego_motion_t, "CREMED_STATUS": package.status_t}


# linux/socket.h: asm-generic; the socket module has no name for it.
SO_TIMESTAMPNS = 35


def stamp_us(ancillary):
    """When the kernel got a datagram, however late it is read."""
    for level, kind, data in ancillary:
        if (level, kind) == (socket.SOL_SOCKET, SO_TIMESTAMPNS):
            seconds, nanoseconds = struct.unpack("=qq", data)
            return seconds * 1_000_000 + nanoseconds // 1000
    raise OSError("a datagram has no stamp")


@dataclass
class Heard:
    """A message and when it came; monotonic_s: was read."""
    wall_us: int
    monotonic_s: float
    message: object

    @property
    def age_s(self):
        return (self.wall_us - self.message.utime) * 1e-6


class LcmListener(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.types = message_types()
        self.heard = {channel: [] for channel in self.types}
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.socket.bind((GROUP, PORT))
        # By address, not by route: it has to hear on lo whatever the routes are.
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(GROUP) + socket.inet_aton("127.0.0.1"))
        self.start()

    def run(self):
        while True:
            datagram, ancillary, *_ = self.socket.recvmsg(65536, 256)
            magic, _ = struct.unpack_from(">4sI", datagram)
            assert magic == b"LC02", "only messages of one datagram are expected"
            channel, payload = datagram[8:].split(b"\0", 1)
            channel = channel.decode()
            if channel in self.types:
                self.heard[channel].append(Heard(stamp_us(ancillary), time.monotonic(),
                                                 self.types[channel].decode(payload)))

    def motions(self, source, since_s=0.0):
        """Motions of a radar that were heard after a time of time.monotonic()."""
        return [heard for heard in list(self.heard["CREMED_EGO_MOTION"])
                if heard.message.source == source and heard.monotonic_s > since_s]

    def estimates(self, source, since_s=0.0):
        return [heard for heard in self.motions(source, since_s) if heard.message.status in (0, 1)]

    def motions_of_scans(self, source, since_us):
        """Of scans that began after a time of time.time_ns() / 1000."""
        return [heard for heard in self.motions(source) if heard.message.utime > since_us]

    def statuses(self, source, since_s=0.0):
        return [heard.message for heard in list(self.heard["CREMED_STATUS"])
                if heard.message.source == source and heard.monotonic_s > since_s]

    def status(self, source):
        """The latest one."""
        return self.statuses(source)[-1]
