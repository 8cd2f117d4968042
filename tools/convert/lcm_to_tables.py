# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""An LCM log of cremed as a folder of CSV files, one a source, whose rows are all of one kind."""
import contextlib
import csv
import io
import pathlib

import cremed
from lcm_to_mcap import OF_TARGETS, STATUS_NAMES, each_once, topic_of
from replaced_file import replaced_file


def columns_of(kind):
    """[(column, field, place in it)]: an array is a column a number. Those of targets come last."""
    fields = cremed.fields_of(kind()).items()
    scalars = [(name, name, None) for name, value in fields if not isinstance(value, list)]
    arrays = [(f"{name}_{i}", name, i) for name, value in fields if isinstance(value, list)
              for i in range(len(value))]
    return scalars + arrays, OF_TARGETS[kind]


class Table:
    def __init__(self, file, kind):
        self.file = io.TextIOWrapper(file, encoding="utf-8", newline="")
        self.rows, self.kind = csv.writer(self.file, lineterminator="\n"), kind
        self.columns, self.targets = columns_of(kind)
        self.rows.writerow(["time_s", *(["status_name"] if STATUS_NAMES[kind] else []),
                            *(column for column, _, _ in self.columns), *self.targets])

    def add(self, message):
        seconds = f"{message.utime // 1_000_000}.{message.utime % 1_000_000:06d}"
        names, fields = STATUS_NAMES[self.kind], cremed.fields_of(message)
        cells = [seconds, *([names.get(message.status, "unknown")] if names else []),
                 *(fields[field] if place is None else fields[field][place] for _, field, place in self.columns)]
        if not self.targets:
            self.rows.writerow(cells)
        for target in zip(*(fields[name] for name in self.targets)):
            self.rows.writerow([*cells, *target])


def write_tables(log, folder, files):
    """How many; and what is wrong with the log, if anything. `files` keeps those that are written open."""
    tables = {}
    try:
        for heard in each_once(cremed.read_log(log)):
            topic = topic_of(heard.message)
            if topic not in tables:
                pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
                path = pathlib.Path(folder) / f"{topic.removeprefix('CREMED_').lower()}.csv"
                tables[topic] = Table(files.enter_context(replaced_file(path)), type(heard.message))
                files.callback(tables[topic].file.detach)  # Flushes.
            tables[topic].add(heard.message)
    except cremed.DamagedLog as damage:
        return len(tables), damage
    return len(tables), None


def convert(log, folder):
    """Raises, after it has converted what comes before damage, where there is any."""
    with contextlib.ExitStack() as files:
        count, damage = write_tables(log, folder, files)
    if damage:
        raise damage
    if count == 0:
        raise ValueError(f"{log}: has none of cremed's messages; record with lcm-logger")
