# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The configurable part of an ARS408 on a virtual bus."""
import contextlib
import socket
import struct
import threading
import time

from can_bus import pack

OBJECTS, CLUSTERS = 1, 2


class FakeArs408(threading.Thread):
    """Sends its state (0x201) once a second, obeys RadarCfg (0x200), answers FilterCfg (0x202)."""

    def __init__(self, bus, sensor_id=0, output=OBJECTS, quality=True, extended=True,
                 range_m=200, obeys=True):
        super().__init__(daemon=True)
        self.sensor_id, self.output, self.range_m = sensor_id, output, range_m
        self.quality, self.extended, self.stored = quality, extended, False
        self.obeys = obeys
        self.commands = []  # Identifier and bytes of each 0x200 and 0x202 to any sensor.
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((bus.name,))
        self.filters = {}  # By index: activity, limits.
        self.ended = threading.Event()
        self.start()

    def state(self):
        distance = self.range_m // 2
        return bytes([self.stored << 7 | 1 << 6, distance >> 2, (distance & 3) << 6, 0,
                      self.sensor_id,
                      self.extended << 5 | self.quality << 4 | self.output << 2, 0, 0])

    def run(self):
        due_s = time.monotonic()
        while not self.ended.is_set():
            with contextlib.suppress(OSError):  # No frame, or the interface is down.
                if time.monotonic() >= due_s:
                    due_s = time.monotonic() + 1  # A late one is not made up for by a second.
                    self.socket.send(pack(0x201 + 0x10 * self.sensor_id, self.state()))
                self.socket.settimeout(max(0.01, due_s - time.monotonic()))
                identifier, length, data = struct.unpack("=IB3x8s", self.socket.recv(16))
                self.hear(identifier, data[:length])

    def hear(self, identifier, data):
        if identifier & ~0x70 in (0x200, 0x202):
            self.commands.append((identifier, data))
        if self.obeys and identifier == 0x200 + 0x10 * self.sensor_id:
            self.obey(data)
        if identifier == 0x202 + 0x10 * self.sensor_id:
            self.answer(data)

    def answer(self, data):
        index = data[0] >> 3 & 15
        if self.obeys and data[0] & 0x02:
            self.filters[index] = bytes([data[0] & 0x04]) + data[1:]
        own = self.filters.get(index, bytes(5))
        self.socket.send(pack(0x203 + 0x10 * self.sensor_id, bytes([6 << 3, 0])))
        self.socket.send(pack(0x204 + 0x10 * self.sensor_id,
                              bytes([own[0] | index << 3]) + own[1:]))

    def obey(self, data):
        valid = data[0]
        if valid & 0x01:
            self.range_m = 2 * (data[1] << 2 | data[2] >> 6)
        if valid & 0x02:
            self.sensor_id = data[4] & 7
        if valid & 0x08:
            self.output = data[4] >> 3 & 3
        if valid & 0x10:
            self.quality = bool(data[5] & 0x04)
        if valid & 0x20:
            self.extended = bool(data[5] & 0x08)
        if valid & 0x80:
            self.stored = bool(data[5] & 0x80)
