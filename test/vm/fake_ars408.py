# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The part of an ARS408 that can be configured, on a virtual bus."""
import socket
import struct
import threading

from can_bus import pack

OBJECTS, CLUSTERS = 1, 2


class FakeArs408(threading.Thread):
    """Reports its state (0x201) ten times a second and obeys RadarCfg (0x200)."""

    def __init__(self, bus, sensor_id=0, output=OBJECTS, quality=True, extended=True,
                 range_m=200, obeys=True):
        super().__init__(daemon=True)
        self.sensor_id, self.output, self.range_m = sensor_id, output, range_m
        self.quality, self.extended, self.stored = quality, extended, False
        self.obeys = obeys
        self.commands = []  # Identifier and bytes of each RadarCfg, whoever it is for.
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((bus.name,))
        self.socket.settimeout(0.1)
        self.ended = threading.Event()
        self.start()

    def state(self):
        distance = self.range_m // 2
        return bytes([self.stored << 7 | 1 << 6, distance >> 2, (distance & 3) << 6, 0,
                      self.sensor_id,
                      self.extended << 5 | self.quality << 4 | self.output << 2, 0, 0])

    def run(self):
        while not self.ended.is_set():
            try:
                self.socket.send(pack(0x201 + 0x10 * self.sensor_id, self.state()))
                identifier, length, data = struct.unpack("=IB3x8s", self.socket.recv(16))
            except OSError:  # Nothing came, or the interface is down.
                continue
            if identifier & ~0x70 == 0x200:
                self.commands.append((identifier, data[:length]))
                if self.obeys and identifier == 0x200 + 0x10 * self.sensor_id:
                    self.obey(data)

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
