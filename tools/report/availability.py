# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""For how much of a drive there was a usable estimate, as tools/eval/drive/recorded_odometry.hpp defines it."""
SHORTEST_PAUSE_US = 250_000


def without(utimes, usable, begin, end):
    """[(begin, end)] in which nothing usable was told, in microseconds."""
    distances = sorted(later - before for before, later in zip(utimes, utimes[1:]))
    longest = max(SHORTEST_PAUSE_US, 2 * distances[len(distances) // 2]) if distances else SHORTEST_PAUSE_US
    spans, told = [], begin
    for utime, is_usable in zip(utimes, usable):
        if not is_usable or utime - told > longest:
            add(spans, told, utime)
        told = max(told, utime)
    add(spans, told, end)
    return spans


def add(spans, begin, end):
    if begin < end:
        if spans and spans[-1][1] == begin:
            begin = spans.pop()[0]
        spans.append((begin, end))


def percent(spans, begin, end):
    return 100 - 100 * sum(until - since for since, until in spans) / (end - begin) if end > begin else None
