# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes MCAP files (mcap.dev/spec), which Foxglove, PlotJuggler and ROS 2 read: messages in chunks with
an index, not compressed."""
import math
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F
CHUNK_BYTES = 1 << 20


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value):
    data = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(data)) + data


def table(layout, rows):
    data = b"".join(struct.pack(layout, *row) for row in rows)
    return struct.pack("<I", len(data)) + data


class Chunk:
    def __init__(self):
        self.data, self.times, self.indexes = bytearray(), [], {}

    def add(self, channel, time_ns, content):
        self.indexes.setdefault(channel, []).append((time_ns, len(self.data)))
        self.times.append(time_ns)
        self.data += record(MESSAGE, content)


class McapWriter:
    """`profile`: its name, the encodings of its messages and schemas, and a schema (name, text) of a kind."""

    def __init__(self, file, library, profile):
        self.file, self.profile, self.chunk = file, profile, Chunk()
        self.schemas, self.channels, self.counts = {}, {}, {}
        self.definitions = {SCHEMA: [], CHANNEL: []}
        self.chunk_indexes, self.first_ns, self.last_ns = [], math.inf, 0
        self.written = 0  # A pipe does not tell.
        self._write(MAGIC + record(HEADER, text(profile.name) + text(library)))

    def add(self, topic, kind, sequence, log_time_ns, publish_time_ns, message):
        """`kind`: of a message, as the profile knows it; `message`: bytes."""
        channel = self.channels.get(topic) or self._define_channel(topic, kind)
        content = struct.pack("<HIQQ", channel, sequence & 0xFFFFFFFF, log_time_ns, publish_time_ns)
        self.chunk.add(channel, log_time_ns, content + message)
        self.counts[channel] = self.counts.get(channel, 0) + 1
        if len(self.chunk.data) >= CHUNK_BYTES:
            self._write_chunk()

    def finish(self):
        self._write_chunk()
        self._write(record(DATA_END, bytes(4)))
        start = self.written
        groups = [(SCHEMA, self.definitions[SCHEMA]), (CHANNEL, self.definitions[CHANNEL]),
                  (STATISTICS, [self._statistics()]), (CHUNK_INDEX, self.chunk_indexes)]
        summary, offsets = b"", b""
        for opcode, contents in groups:
            group = b"".join(record(opcode, content) for content in contents)
            offsets += record(SUMMARY_OFFSET,
                              struct.pack("<BQQ", opcode, start + len(summary), len(group)))
            summary += group
        footer = struct.pack("<QQ", start, start + len(summary))
        checked = summary + offsets + struct.pack("<BQ", FOOTER, len(footer) + 4) + footer
        self._write(checked + struct.pack("<I", zlib.crc32(checked)) + MAGIC)

    def _write(self, data):
        self.file.write(data)
        self.written += len(data)

    def _define(self, opcode, content):
        self.definitions[opcode].append(content)
        self.chunk.data += record(opcode, content)

    def _define_channel(self, topic, kind):
        if kind not in self.schemas:
            number = self.schemas[kind] = len(self.schemas) + 1
            name, schema = self.profile.schema(kind)
            self._define(SCHEMA, struct.pack("<H", number) + text(name) + text(self.profile.schema_encoding)
                         + text(schema))
        number = self.channels[topic] = len(self.channels) + 1
        self._define(CHANNEL, struct.pack("<HH", number, self.schemas[kind]) + text(topic)
                     + text(self.profile.encoding) + table("", []))
        return number

    def _write_chunk(self):
        chunk, self.chunk = self.chunk, Chunk()
        if not chunk.times:
            return
        first, last, size = min(chunk.times), max(chunk.times), len(chunk.data)
        self.first_ns = min(self.first_ns, first)
        self.last_ns = max(self.last_ns, last)
        start = self.written
        self._write(record(CHUNK, struct.pack("<QQQI", first, last, size, zlib.crc32(chunk.data))
                           + text("") + struct.pack("<Q", size) + chunk.data))
        index_start, offsets = self.written, []
        for channel, entries in chunk.indexes.items():
            offsets.append((channel, self.written))
            self._write(record(MESSAGE_INDEX, struct.pack("<H", channel)
                               + table("<QQ", sorted(entries))))
        self.chunk_indexes.append(
            struct.pack("<QQQQ", first, last, start, index_start - start) + table("<HQ", offsets)
            + struct.pack("<Q", self.written - index_start) + text("")
            + struct.pack("<QQ", size, size))

    def _statistics(self):
        return struct.pack("<QHIIIIQQ", sum(self.counts.values()), len(self.schemas),
                           len(self.channels), 0, 0, len(self.chunk_indexes),
                           self.first_ns if self.counts else 0, self.last_ns) + table("<HQ", self.counts.items())
