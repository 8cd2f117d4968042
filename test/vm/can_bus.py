# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A virtual CAN bus, and a radar that talks on it."""
import contextlib
import socket
import struct
import subprocess
import threading
import time

EXTENDED, REMOTE, ERROR = 0x80000000, 0x40000000, 0x20000000
# Classes of error frames, as in linux/can/error.h.
ERROR_CONTROLLER, ERROR_PROTOCOL, ERROR_BUS_OFF = 0x04, 0x08, 0x40
ERROR_BUS, ERROR_RESTARTED = 0x80, 0x100


def ip(*arguments, check=True):
    return subprocess.run(["ip", *arguments], check=check, capture_output=True, text=True)


def pack(identifier, data=b""):
    return struct.pack("=IB3x8s", identifier, len(data), data)


class CanBus:
    """One vcan interface of this network namespace."""

    def __init__(self, name):
        self.name = name

    def create(self):
        ip("link", "add", self.name, "type", "vcan")
        self.up()
        return self

    def delete(self):
        ip("link", "delete", self.name)

    def up(self):
        ip("link", "set", self.name, "up")

    def down(self):
        ip("link", "set", self.name, "down")

    def open(self):
        sender = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        sender.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FD_FRAMES, 1)
        sender.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FILTER, b"")
        sender.bind((self.name,))
        return sender

    def send(self, identifier, data=b"", count=1):
        """`identifier` with flags; an error frame where it holds ERROR."""
        with self.open() as sender:
            for _ in range(count):
                sender.send(pack(identifier, data))

    def send_fd(self, identifier, data):
        with self.open() as sender:
            sender.send(struct.pack("=IBB2x64s", identifier, len(data), 0, data))


class BusListener:
    """Hears frames of given identifiers on a bus."""

    def __init__(self, bus, *identifiers):
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        filters = b"".join(struct.pack("=II", identifier, 0x7FF) for identifier in identifiers)
        self.socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FILTER, filters)
        self.socket.bind((bus.name,))
        self.socket.setblocking(False)

    def heard(self):
        """[(identifier, data)] since the last call."""
        frames = []
        with contextlib.suppress(BlockingIOError):
            while True:
                identifier, length, data = struct.unpack("=IB3x8s", self.socket.recv(16))
                frames.append((identifier, data[:length]))
        return frames


def read_log(path, interface):
    """[(seconds since the first frame, packed frame)] of one interface in a candump log."""
    frames, start = [], None
    with open(path, encoding="ascii") as log:
        for line in log:
            words = line.split()
            if len(words) == 3 and words[1] == interface:
                stamp = float(words[0].strip("()"))
                start = stamp if start is None else start
                identifier, data = words[2].split("#")
                frames.append((stamp - start, pack(int(identifier, 16), bytes.fromhex(data))))
    return frames


class RadarPlayer(threading.Thread):
    """Plays one interface of a log at real speed, over and over, whatever becomes of the bus."""

    def __init__(self, bus, log):
        super().__init__(daemon=True)
        self.bus = bus
        self.frames = read_log(log, bus.name)
        self.cycle_s = self.frames[-1][0] + 0.07
        self.silent = threading.Event()
        self.ended = threading.Event()
        self.sender = None
        self.start()

    def run(self):
        begin, number = time.monotonic(), 0
        while not self.ended.is_set():
            cycles, index = divmod(number, len(self.frames))
            after_s, frame = self.frames[index]
            wait_s = begin + cycles * self.cycle_s + after_s - time.monotonic()
            if wait_s > 0:
                time.sleep(max(wait_s, 0.001))
            if not self.silent.is_set():
                self.send(frame)
            number += 1

    def send(self, frame):
        try:
            if self.sender is None:
                self.sender = self.bus.open()
            self.sender.send(frame)
        except OSError:  # Down or gone: the radar does not mind.
            if self.sender:
                self.sender.close()
            self.sender = None
            time.sleep(0.01)

    def stop(self):
        self.ended.set()
        self.join()
