# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""An LCM log of cremed as a folder of CSV files, one a source, whose rows are all of one kind."""
import csv
import pathlib

import cremed
from lcm_to_mcap import STATUS_NAMES, each_once, topic_of


def is_list_of_targets(value):
    return isinstance(value, list) and not value


def columns_of(kind):
    """[(column, field, place in it)]: an array is a column a number. Those of targets come last."""
    fields = [(name, getattr(kind(), name)) for name in kind.__slots__]
    scalars = [(name, name, None) for name, value in fields if not isinstance(value, list)]
    arrays = [(f"{name}_{i}", name, i) for name, value in fields if isinstance(value, list)
              for i in range(len(value))]
    return scalars + arrays, [name for name, value in fields if is_list_of_targets(value)]


class Table:
    def __init__(self, path, kind):
        self.file = open(path, "w", newline="", encoding="utf-8")  # pylint: disable=consider-using-with
        self.rows, self.kind = csv.writer(self.file, lineterminator="\n"), kind
        self.columns, self.targets = columns_of(kind)
        self.rows.writerow(["time_s", *(["status_name"] if STATUS_NAMES[kind] else []),
                            *(column for column, _, _ in self.columns), *self.targets])

    def add(self, message):
        seconds = f"{message.utime // 1_000_000}.{message.utime % 1_000_000:06d}"
        names = STATUS_NAMES[self.kind]
        cells = [seconds, *([names.get(message.status, "unknown")] if names else []),
                 *(getattr(message, field) if place is None else getattr(message, field)[place]
                   for _, field, place in self.columns)]
        if not self.targets:
            self.rows.writerow(cells)
        for target in zip(*(getattr(message, name) for name in self.targets)):
            self.rows.writerow([*cells, *target])


def convert(log, folder):
    """Raises, after it has converted what comes before damage, where there is any."""
    tables = {}
    try:
        for heard in each_once(cremed.read_log(log)):
            topic = topic_of(heard.message)
            if topic not in tables:
                pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
                name = topic.removeprefix("CREMED_").lower()
                tables[topic] = Table(pathlib.Path(folder) / f"{name}.csv", type(heard.message))
            tables[topic].add(heard.message)
    finally:
        for table in tables.values():
            table.file.close()
    if not tables:
        raise ValueError(f"{log}: has none of cremed's messages; record with lcm-logger")
