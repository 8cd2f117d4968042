# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A message's values and the names of its constants."""
import functools

# Members of status_t that grow: their places have the names of these constants.
LISTS = {"counters": "COUNTER_", "figures": "FIGURE_"}


def names_of(kind, prefix):
    """{0: "ok", ...}, of the constants STATUS_OK = 0, ..."""
    return {getattr(kind, name): name.removeprefix(prefix).lower()
            for name in dir(kind) if name.startswith(prefix)}


@functools.cache
def _named_places(kind, prefix):
    return sorted(names_of(kind, prefix).items())


def fields_of(message):
    """{name: value}, with each counter and figure of a status_t under its own name."""
    values = {}
    for name in message.__slots__:
        value = getattr(message, name)
        if name in LISTS:
            values |= {one: value[place] for place, one in _named_places(type(message), LISTS[name])}
        else:
            values[name] = value
    return values
