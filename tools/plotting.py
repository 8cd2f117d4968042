# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Matplotlib for the plot scripts. What keeps a picture from being drawn is a line, not a traceback."""
import signal
import sys

signal.signal(signal.SIGINT, lambda *_: sys.exit(1))  # cremed-eval says more, or ends too.
try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot  # noqa: F401
except ImportError as error:
    sys.exit(f"{error.name or error} is missing: install python3-matplotlib")


def _tell(kind, error, trace):
    if issubclass(kind, OSError):  # No room; cremed-eval was killed, and its tables are gone.
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = _tell


def save(figure, picture, dpi):
    try:
        figure.savefig(picture, dpi=dpi)
    except ValueError as error:  # A format that it does not know.
        sys.exit(str(error))
