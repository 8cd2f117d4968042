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


def save(figure, picture, dpi):
    try:
        figure.savefig(picture, dpi=dpi)
    except (OSError, ValueError) as error:  # No room; a format that it does not know.
        sys.exit(str(error))
