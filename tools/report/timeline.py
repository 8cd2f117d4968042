# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""One time through a log in which the clock was set, or cremed began anew."""
from dataclasses import dataclass

# Less is left as it is: the sources' messages are not in the order of time among each other.
STEP_US = 500_000
# Of one drive. After a longer one, where no clock tells, either is no part of it.
LONGEST_PAUSE_US = 3_600_000_000
# The statuses, one a second, tell later than the motions that the clock was set.
RECENT_US = 2_500_000
# Of a radar's cycle counter, ARS408: 65536 cycles. That of a Bosch GPR passes through 0 in a pause: no evidence.
MIN_COUNTER, COUNTER_TURN = 256, 65536


@dataclass
class Break:
    """What comes from `utime` on, which is of the common time, does not continue what comes before."""
    utime: int
    kind: str  # "clock", "pause" or "restart".
    by_us: int = 0  # How far the clock was set.


class Timeline:
    """Of messages in the order of the log. `move(since, by)` is called to change times that were given."""

    def __init__(self, move):
        self.move, self.breaks, self.runs = move, [], 0
        self.now, self.offset, self.gap, self.clock_steps = None, 0, None, None
        self.streams = {}  # Of each the last message: (offset, utime, seq).
        self.cycles = {}   # Of each radar the last scan: (utime, counter, period).

    def joined(self, stream, utime, seq):
        """The common time of a stream's next message."""
        if self.now is None:
            self.now = utime
        offset, last, last_seq = self.streams.get(stream, (self.offset, utime, -1))
        if seq <= last_seq and not 0 <= last - utime <= STEP_US:  # Neither overtaken nor heard twice.
            self._restart()
        if abs(utime + self.offset - self.now) < abs(utime + offset - self.now):
            offset = self.offset  # Another stream has shown that the clock was set.
        if utime < last - STEP_US and utime + offset < self.now - STEP_US:
            self.breaks.append(Break(self.now + 1, "clock", utime - last))
            offset = self.offset = self.now + 1 - utime
        elif utime > last + STEP_US and utime + offset > self.now + STEP_US:
            self.gap = self.now, utime + offset
        self.streams[stream] = offset, utime, seq
        self.now = max(self.now, utime + offset)
        if self.gap and self.gap[1] - self.gap[0] > LONGEST_PAUSE_US:
            self._close_gap("pause")
        return utime + self.streams[stream][0]

    def _restart(self):
        self.runs, self.clock_steps = self.runs + 1, None
        self.streams.clear()
        self.breaks.append(Break(self.now + 1, "restart"))

    def _close_gap(self, kind):
        (before, after), self.gap = self.gap, None
        by = after - before - 1
        self.breaks.append(Break(before + 1, kind, by))
        self.move(after, -by)
        self.streams = {stream: (offset - by if utime + offset >= after else offset, utime, seq)
                        for stream, (offset, utime, seq) in self.streams.items()}
        self.offset, self.now = self.offset - by, self.now - by

    def _set_forward(self):
        if self.gap and self.now - self.gap[1] < RECENT_US:
            self._close_gap("clock")
        elif self.breaks and self.breaks[-1].kind == "pause" and self.now - self.breaks[-1].utime < RECENT_US:
            self.breaks[-1].kind = "clock"

    def note_clock_steps(self, count):
        """What a status counts."""
        if self.clock_steps is not None and count > self.clock_steps:
            self._set_forward()
        self.clock_steps = max(count, self.clock_steps or 0)

    def note_cycle(self, radar, utime, counter):
        """Of a scan. In a pause the radar counts on, and not where the clock was set (daemon/bus_clocks.hpp)."""
        last, before, period = self.cycles.get(radar, (utime, counter, None))
        passed, counts = utime - last, (counter - before) % COUNTER_TURN
        if 0 < passed <= STEP_US and counts:
            period = passed / counts
        elif period and before >= MIN_COUNTER and counts * period < STEP_US < passed - counts * period:
            self._set_forward()
        self.cycles[radar] = utime, counter, period
