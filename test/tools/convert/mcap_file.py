# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A reader of MCAP files, JSON and messages of ROS 2, by the public specifications."""
import json
import re
import struct
import zlib


def records(data):
    at = 0
    while at < len(data):
        opcode, length = struct.unpack_from("<BQ", data, at)
        yield opcode, data[at + 9:at + 9 + length]
        at += 9 + length


def take_text(data, at):
    length = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + length].decode(), at + 4 + length


FIELD = re.compile(r"^(\S+?)(\[(\d*)\])? (\w+)$", re.MULTILINE)
NUMBERS = {"uint8": "B", "byte": "B", "bool": "?", "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}


def ros2_definitions(text):
    """{type: [(type, is an array, count, name)]}; "" is the type of the message. From the schema in the file alone."""
    parts = re.split(r"^=+\nMSG: (\S+)\n", text, flags=re.MULTILINE)
    return {name: [(kind, bool(array), count, field)
                   for kind, array, count, field in FIELD.findall(re.sub(r".*=.*\n", "", part))]
            for name, part in zip(["", *parts[1::2]], parts[::2])}


class CdrReader:
    """Little-endian CDR, version 1: each number aligned to its size, behind a header of four bytes."""

    def __init__(self, data, definitions):
        assert data[:4] == b"\0\1\0\0"
        self.data, self.at, self.definitions = data[4:], 0, definitions

    def number(self, layout):
        size = struct.calcsize(layout)
        self.at += -self.at % size
        self.at += size
        return struct.unpack_from("<" + layout, self.data, self.at - size)[0]

    def value(self, kind):
        if kind in NUMBERS:
            return self.number(NUMBERS[kind])
        if kind != "string":
            return self.message(kind)
        length = self.number("I")
        self.at += length
        assert self.data[self.at - 1] == 0
        return self.data[self.at - length:self.at - 1].decode()

    def message(self, kind=""):
        return {name: [self.value(part) for _ in range(int(count) if count else self.number("I"))] if is_array
                else self.value(part) for part, is_array, count, name in self.definitions[kind]}


def read_cdr(data, schema):
    reader = CdrReader(data, schema[1])
    message = reader.message()
    assert reader.at == len(reader.data), "bytes are left"
    return message


class McapFile:
    """As the specification has it: opcodes 1 header, 3 schema, 4 channel, 5 message, 6 chunk, 11 statistics."""
    read_schema = {"jsonschema": json.loads, "ros2msg": ros2_definitions}
    read = {"json": lambda data, _: json.loads(data), "cdr": read_cdr}

    def __init__(self, data):
        magic = b"\x89MCAP0\r\n"
        assert data[:8] == magic and data[-8:] == magic
        start, _, crc = struct.unpack("<QQI", data[-28:-8])
        assert data[-37] == 2 and zlib.crc32(data[start:-12]) == crc
        self.schemas, self.channels, self.messages, self.count = {}, {}, [], None
        for opcode, content in records(data[8:-8]):
            if opcode == 1:
                self.profile = take_text(content, 0)[0]
            elif opcode == 6:
                size, checksum = struct.unpack_from("<QI", content, 16)
                chunk = content[-size:]
                assert zlib.crc32(chunk) == checksum and take_text(content, 28)[0] == ""
                for inner in records(chunk):
                    self.take(*inner)
            elif opcode == 11:
                self.count = struct.unpack_from("<Q", content)[0]

    def take(self, opcode, content):
        if opcode == 3:
            name, at = take_text(content, 2)
            encoding, at = take_text(content, at)
            self.schemas[content[:2]] = (name, self.read_schema[encoding](take_text(content, at)[0]))
        elif opcode == 4:
            topic, at = take_text(content, 4)
            self.channels[content[:2]] = (topic, content[2:4], take_text(content, at)[0])
        elif opcode == 5:
            topic, schema, encoding = self.channels[content[:2]]
            sequence, log_time = struct.unpack_from("<IQ", content, 2)
            self.messages.append({"topic": topic, "schema": self.schemas[schema][0],
                                  "sequence": sequence, "log_time": str(log_time),
                                  "data": self.read[encoding](content[22:], self.schemas[schema])})
