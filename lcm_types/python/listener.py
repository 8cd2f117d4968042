# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed's messages as LCM sends and records them, without LCM's library: Debian has no binding."""
import collections
import socket
import struct
from dataclasses import dataclass

from .ego_motion_t import ego_motion_t
from .odometry_t import odometry_t
from .radar_scan_t import radar_scan_t
from .status_t import status_t

GROUP, PORT = "239.255.76.67", 7667  # LCM's default.
LONGEST_DATAGRAM = 65536
MAGIC_SHORT, MAGIC_EVENT = 0x4C433032, b"\xED\xA1\xDA\x01"
EVENT = struct.Struct(">4sqqII")  # Magic, number, time, lengths of channel and payload.
# Of a log: more than LCM's own for a channel, and than any message of a robot has.
LONGEST_CHANNEL, LONGEST_PAYLOAD = 999, 1 << 28
READ_BYTES = 1 << 18  # Of a log at once.
# linux/socket.h (asm-generic); the socket module does not define it.
SO_TIMESTAMPNS = 35
# A message begins with the fingerprint of its type, so the channel is not needed.
# pylint: disable=protected-access
TYPES = {kind._get_packed_fingerprint(): kind
         for kind in (ego_motion_t, odometry_t, radar_scan_t, status_t)}
# Of a message that is of another version the channel tells what it is.
CHANNELS = {"CREMED_ODOMETRY": odometry_t, "CREMED_EGO_MOTION": ego_motion_t, "CREMED_SCAN_": radar_scan_t,
            "CREMED_STATUS": status_t}


@dataclass
class Heard:
    """A message, its channel, and when the kernel got it, or lcm-logger: microseconds since 1970."""
    channel: str
    received_us: int
    message: object


def decoded(channel, received_us, payload):
    """None, if it is not one of cremed's."""
    kind = TYPES.get(bytes(payload[:8]))
    try:
        return kind and Heard(channel, received_us, kind.decode(bytes(payload)))
    except (struct.error, ValueError):  # Cut off.
        return None


class OtherVersions:
    """Counts the messages on cremed's channels that are none of this version's."""

    def __init__(self):
        self.counts = collections.Counter()

    def add(self, channel):
        kinds = [kind for begin, kind in CHANNELS.items() if channel.startswith(begin)]
        self.counts.update(kind.__name__ for kind in kinds)

    def text(self, path):
        """"" if there were none."""
        counts = ", ".join(f"{count} {name}" for name, count in sorted(self.counts.items()))
        return counts and (f"{path}: messages of another version of cremed are left out ({counts}): read them with "
                           "that version, or replay the candump log with this one")


class Listener:
    """Iterates over what is heard, for ever. `interface` is an address of this computer: "127.0.0.1"
    hears what is published with a route on lo, "" leaves the choice to the routes."""

    def __init__(self, group=GROUP, port=PORT, interface=""):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        for option in (socket.SO_REUSEADDR, socket.SO_REUSEPORT, SO_TIMESTAMPNS):
            self.socket.setsockopt(socket.SOL_SOCKET, option, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind((group, port))
        membership = socket.inet_aton(group) + socket.inet_aton(interface or "0.0.0.0")
        try:
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        except OSError as error:
            raise OSError(error.errno, f"cannot join {group}, {error.strerror}: multicast needs a route "
                          "(systemctl start cremed-multicast-route), or interface=\"127.0.0.1\"") from error

    def receive(self, timeout_s=None):
        """The next datagram's message: None after `timeout_s`, and where it is none of cremed's."""
        self.socket.settimeout(timeout_s)
        try:
            datagram, ancillary, *_ = self.socket.recvmsg(LONGEST_DATAGRAM, 256)
        except TimeoutError:
            return None
        # Messages of several datagrams have another magic; cremed's messages all fit one.
        if len(datagram) < 8 or struct.unpack_from(">I", datagram)[0] != MAGIC_SHORT:
            return None
        channel, _, payload = datagram[8:].partition(b"\0")
        return decoded(channel.decode(errors="replace"), _stamp_us(ancillary), payload)

    def __iter__(self):
        while True:
            if (heard := self.receive()) is not None:
                yield heard


def _stamp_us(ancillary):
    for level, kind, data in ancillary:
        if (level, kind) == (socket.SOL_SOCKET, SO_TIMESTAMPNS):
            seconds, nanoseconds = struct.unpack("=qq", data)
            return seconds * 1_000_000 + nanoseconds // 1000
    raise OSError("a datagram has no stamp")


class DamagedLog(ValueError):
    """Says where; what comes before was read."""


def read_events(path):
    """Iterates over all of such a log as (channel, received_us, payload), not decoded. Raises DamagedLog
    after what comes before the damage."""
    with open(path, "rb", READ_BYTES) as log:
        for event in events_in(log):
            yield event[:3]


def events_in(log):
    """The same of a log opened at its begin, as (channel, received_us, payload, byte behind it)."""
    at, path = 0, log.name
    while header := log.read(EVENT.size):
        magic, _, received_us, channel_length, length = EVENT.unpack(header.ljust(EVENT.size, b"\0"))
        if magic != MAGIC_EVENT and not MAGIC_EVENT.startswith(header):
            raise DamagedLog(f"{path}: damaged at byte {at}: no message begins there" if at else
                             f"{path}: is no LCM log; of a candump log `cremed --config FILE --replay LOG "
                             "--publish-scans --lcm-url 'file://OUT?mode=w'` makes one")
        if channel_length > LONGEST_CHANNEL or length > LONGEST_PAYLOAD:
            raise DamagedLog(f"{path}: damaged at byte {at}: the message there has impossible lengths")
        event = log.read(channel_length + length)
        begin, at = at, at + EVENT.size + channel_length + length
        if len(event) < channel_length + length or len(header) < EVENT.size:
            raise DamagedLog(f"{path}: ends inside a message, which begins at byte {begin}")
        yield event[:channel_length].decode(errors="replace"), received_us, event[channel_length:], at


def read_log(path):
    """Iterates over cremed's messages of a log that lcm-logger, or cremed itself, has written. Raises
    DamagedLog, after all of them, if others are of another version of cremed."""
    others = OtherVersions()
    for event in read_events(path):
        if (heard := decoded(*event)) is not None:
            yield heard
        else:
            others.add(event[0])
    if text := others.text(path):
        raise DamagedLog(text)
