# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is left of long series for a picture: of each bin the extremes, so that no peak is lost."""
import math

BINS = 1000


def extremes(columns, bins=BINS):
    """Indices, in order: the first and the last, and of each bin those of every column's least and
    greatest value. All, where there are few."""
    count = len(columns[0])
    kept = {0, count - 1} if count else set()
    size = max(count // bins, 1)
    for begin in range(0, count, size):
        places = range(begin, min(begin + size, count))
        for column in columns:
            numbers = [i for i in places if not math.isnan(column[i])] or places[:1]
            kept.add(min(numbers, key=column.__getitem__))
            kept.add(max(numbers, key=column.__getitem__))
    return sorted(kept)


def runs(times, values, bins=2 * BINS):
    """[(time, value)] where the value changes. Of a bin with many changes, its greatest value."""
    width = (times[-1] - times[0]) / bins if times else 0
    result, before = [], None
    for time, value in zip(times, values):
        if result and time - result[-1][0] < width:
            value = max(value, result[-1][1])
            result[-1] = (result[-1][0], value)
        elif value != before:
            result.append((time, value))
        before = value
    return merged(result)


def merged(changes):
    return [change for i, change in enumerate(changes) if i == 0 or change[1] != changes[i - 1][1]]


def evenly(times, begin, end, count):
    """Indices of those that are the last at `count` instants of the time between."""
    kept, at = set(), 0
    for step in range(count + 1):
        instant = begin + (end - begin) * step / count
        while at + 1 < len(times) and times[at + 1] <= instant:
            at += 1
        kept.add(at)
    return sorted(kept) if times else []


def rounded(values, digits=5):
    """Significant digits; NaN, which JSON has not, becomes None."""
    return [None if math.isnan(value) else float(f"{value:.{digits}g}") for value in values]
