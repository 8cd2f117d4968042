# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the plot scripts share. What keeps a picture from being drawn is a line, not a traceback."""
import csv
import os
import signal
import sys
import tempfile


def _tell(kind, error, trace):
    if issubclass(kind, OSError):  # No room; cremed-eval was killed, and its tables are gone.
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = _tell
# It ends without a word: cremed-eval says more, or ends too. An exception could come where importing
# tells of it instead.
if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
# What Matplotlib leaves behind where it has no home: cremed-eval removes the folder.
tempfile.tempdir = os.path.dirname(os.path.abspath(sys.argv[-1]))
try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot  # noqa: F401
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
except ImportError as error:
    sys.exit(f"{error.name or error} is missing: install python3-matplotlib")


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def log_scale(axis, decimals=(1, 2, 5)):
    axis.set_yscale("log")
    axis.yaxis.set_major_locator(LogLocator(subs=decimals))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.yaxis.set_minor_locator(NullLocator())


def save(figure, picture, dpi):
    try:
        figure.savefig(picture, dpi=dpi)
    except ValueError as error:  # A format that it does not know.
        sys.exit(str(error))
