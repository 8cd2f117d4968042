# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A virtual CAN bus, and a radar on it."""
import contextlib
import errno
import itertools
import json
import mmap
import multiprocessing
import os
import pathlib
import socket
import struct
import subprocess
import time
from dataclasses import dataclass

EXTENDED, REMOTE, ERROR = 0x80000000, 0x40000000, 0x20000000
# Classes of error frames, as in linux/can/error.h.
ERROR_CONTROLLER, ERROR_PROTOCOL, ERROR_BUS_OFF = 0x04, 0x08, 0x40
ERROR_BUS, ERROR_RESTARTED = 0x80, 0x100
# linux/socket.h (asm-generic); the socket module does not define it.
SO_TIMESTAMPNS = 35
ALL_FRAMES_RECEIVERS = pathlib.Path("/proc/net/can/rcvlist_all")


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

    def is_listened_to(self):
        """Whether a socket receives all of its frames."""
        receivers = ALL_FRAMES_RECEIVERS.read_text().splitlines()
        return any(line.split()[:1] == [self.name] for line in receivers)

    def frames_sent(self):
        """By all nodes, since the interface was created."""
        return json.loads(ip("-json", "-statistics", "link", "show", self.name).stdout)[0][
            "stats64"]["tx"]["packets"]

    def send(self, identifier, data=b"", count=1):
        """`identifier` with flags; an error frame if it includes ERROR."""
        with self.open() as sender:
            for _ in range(count):
                sender.send(pack(identifier, data))

    def send_fd(self, identifier, data):
        with self.open() as sender:
            sender.send(struct.pack("=IBB2x64s", identifier, len(data), 0, data))


class BusListener:
    """Receives frames with given identifiers."""

    def __init__(self, bus, *identifiers):
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        filters = b"".join(struct.pack("=II", identifier, 0x7FF) for identifier in identifiers)
        self.socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_FILTER, filters)
        self.socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.socket.bind((bus.name,))
        self.socket.setblocking(False)

    def heard_at(self):
        """[(stamp in microseconds, identifier, data)] since the last call."""
        frames = []
        with contextlib.suppress(BlockingIOError):
            while True:
                try:
                    frame, ancillary, *_ = self.socket.recvmsg(16, 64)
                except OSError as error:
                    if error.errno == errno.ENETDOWN:
                        continue  # Told once.
                    raise
                identifier, length, data = struct.unpack("=IB3x8s", frame)
                seconds, nanoseconds = struct.unpack("=qq", ancillary[0][2])
                frames.append((seconds * 1_000_000 + nanoseconds // 1000, identifier, data[:length]))
        return frames

    def heard(self):
        """[(identifier, data)] since the last call."""
        return [(identifier, data) for _, identifier, data in self.heard_at()]


# Messages that tell an ARS408 the vehicle's motion.
SPEED, YAW_RATE = 0x300, 0x301
SPEED_STEP_MPS = 0.02


def speeds_of(frames):
    """[(stamp in microseconds, m/s)] of the speeds among BusListener.heard_at's frames."""
    return [(stamp_us, ((data[0] & 0x1F) << 8 | data[1]) * SPEED_STEP_MPS)
            for stamp_us, name, data in frames if name == SPEED]


# A longer pause of a radar separates two scans.
SCAN_PAUSE_S = 0.004
# A scan that would begin later than this is omitted, so that stamps stay near the drive's.
LATEST_SCAN_S = 0.005
# Frames of this time span are sent together: a sleep costs more than a frame.
BURST_S = 0.002


def sensor_of(identifier):
    """An ARS408's id, part of the identifiers of its messages; all other frames are one sensor."""
    return (identifier >> 4) & 7 if identifier >= 0x600 else None


@dataclass
class Burst:
    """Frames of one sensor."""
    after_s: float  # Since the first frame of the log.
    sensor: object
    begins_scan: bool
    frames: list


def read_log(path, interface):
    """[Burst] of one interface in a candump log."""
    bursts, first, last = [], None, {}
    with open(path, encoding="ascii") as log:
        for line in log:
            words = line.split()
            if len(words) != 3 or words[1] != interface:
                continue
            stamp_s = float(words[0].strip("()"))
            first = stamp_s if first is None else first
            identifier, data = words[2].split("#")
            sensor = sensor_of(int(identifier, 16))
            begins = stamp_s - last.get(sensor, 0.0) > SCAN_PAUSE_S
            last[sensor] = stamp_s
            if (begins or not bursts or bursts[-1].sensor != sensor
                    or stamp_s - first - bursts[-1].after_s > BURST_S):
                bursts.append(Burst(stamp_s - first, sensor, begins, []))
            bursts[-1].frames.append(pack(int(identifier, 16), bytes.fromhex(data)))
    return bursts


class Flag:
    """A threading.Event between two processes."""

    def __init__(self):
        self.memory = mmap.mmap(-1, 1)

    def set(self):
        self.memory[0] = 1

    def clear(self):
        self.memory[0] = 0

    def is_set(self):
        return self.memory[0] == 1


class RadarPlayer(multiprocessing.Process):
    """Replays one interface of a log repeatedly at real speed, whatever the state of the bus, with a
    priority like hardware. If the computer is too slow it omits scans."""

    def __init__(self, bus, log):
        super().__init__(daemon=True)
        self.bus = bus
        self.bursts = read_log(log, bus.name)
        self.cycle_s = self.bursts[-1].after_s + 0.07
        self.silent = Flag()
        self.scans = mmap.mmap(-1, 8)
        self.sender = None
        self.parent = os.getpid()
        self.start()

    def run(self):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(30))
        begin_s = time.monotonic()
        left_out = set()
        for cycle in itertools.count():
            for burst in self.bursts:
                wait_s = begin_s + cycle * self.cycle_s + burst.after_s - time.monotonic()
                if wait_s > 0:
                    time.sleep(wait_s)
                if burst.begins_scan:
                    self.begin_scan(burst.sensor, wait_s, left_out)
                if not self.silent.is_set() and burst.sensor not in left_out:
                    for frame in burst.frames:
                        self.send(frame)

    def begin_scan(self, sensor, wait_s, left_out):
        if os.getppid() != self.parent:
            os._exit(0)
        left_out.discard(sensor)
        if wait_s < -LATEST_SCAN_S:
            left_out.add(sensor)
        elif not self.silent.is_set():
            struct.pack_into("=Q", self.scans, 0, self.scans_begun() + 1)

    def scans_begun(self):
        """Number of scans on the bus, of all sensors."""
        return struct.unpack_from("=Q", self.scans)[0]

    def send(self, frame):
        try:
            if self.sender is None:
                self.sender = self.bus.open()
            self.sender.send(frame)
        except OSError:  # Down or removed: the radar continues.
            if self.sender:
                self.sender.close()
            self.sender = None
            time.sleep(0.01)

    def stop(self):
        self.terminate()
        self.join()
