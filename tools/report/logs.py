# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which logs are meant."""
import os
import pathlib
import re

import main_program

# One `candump` for each bus begins within that.
AT_ONCE_S = 10


def logs_in(folder):
    """[(log, name of its page)]: all below it that are named as candump and lcm-logger name them."""
    logs = sorted(path for path in pathlib.Path(folder).rglob("*") if path.suffix in (".log", ".lcm") and path.is_file())
    if not logs:
        packed = next(pathlib.Path(folder).rglob("*.log.gz"), None)
        raise main_program.UsageError(f"{folder}: has no file *.log or *.lcm" + (
            f"; unpack those that are packed, as `gunzip --keep {packed}` does" if packed else ""))
    return [(str(log), "-".join(log.relative_to(folder).with_suffix("").parts)) for log in logs]


def named_logs(paths):
    for path in paths:
        if path == "-":
            raise main_program.UsageError("LOG: a page is made of a file, not of a pipe")
        yield from logs_in(path) if os.path.isdir(path) else [(path, pathlib.Path(path).stem)]


def first_stamp_s(log):
    """Of a candump log; None if its first line has none."""
    try:
        with open(log, "rb") as file:
            found = re.match(rb"\s*\((\d+\.\d+)\)", file.readline(200))
    except OSError:  # Told when it is replayed.
        return None
    return float(found[1]) if found else None


def begun_at_once(logs):
    """Of each whether another begins at the same time."""
    begins = [first_stamp_s(log) for log in logs]
    return [begin is not None and sum(other is not None and abs(other - begin) < AT_ONCE_S for other in begins) > 1
            for begin in begins]
