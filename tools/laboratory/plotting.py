# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Matplotlib for the plot scripts. What keeps a picture from being drawn is a line, not a traceback."""
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
except ImportError as error:
    sys.exit(f"{error.name or error} is missing: install python3-matplotlib")


def save(figure, picture, dpi):
    try:
        figure.savefig(picture, dpi=dpi)
    except ValueError as error:  # A format that it does not know.
        sys.exit(str(error))
