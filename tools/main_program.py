# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What all programs do, as daemon/process and tools/program.cpp for those in C++: streams, signals,
errors, outputs that are inputs."""
import argparse
import contextlib
import os
import signal
import sys
import tempfile

FAILURE, BAD_USAGE = 1, 2
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class UsageError(Exception):
    """The command line is wrong."""


class Parser(argparse.ArgumentParser):
    """Of a program whose help is written out, in the form of those in C++."""

    def __init__(self, help_text, version=None):
        super().__init__(add_help=False, allow_abbrev=False)
        self.help_text = help_text
        self.add_argument("-h", "--help", action="help")
        if version:
            self.add_argument("--version", action="version", version=version)

    def error(self, message):
        usage = self.help_text.splitlines()[1].removeprefix("Usage: ")
        raise UsageError(f"{message}; must be called as: {usage}; --help tells more")

    def format_help(self):
        return self.help_text


class Stopped(BaseException):
    """By a signal: what was begun is taken back on the way out."""

    def __init__(self, number):
        super().__init__(number)
        self.number = number


def _stop(number, _):
    for other in SIGNALS:  # A second one must not disturb what takes back.
        signal.signal(other, signal.SIG_IGN)
    raise Stopped(number)


def raise_when_stopped():
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:  # nohup
            signal.signal(number, _stop)


def hold_back_signals():
    """Until release_signals(), so that what takes back is set up as soon as there is something to."""
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)


def release_signals():
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


@contextlib.contextmanager
def temporary_folder(prefix):
    """Removed at the end, by a signal too."""
    hold_back_signals()
    try:
        with tempfile.TemporaryDirectory(prefix=prefix, dir=os.environ.get("TMPDIR", "/tmp")) as name:
            try:
                release_signals()
                yield name
            finally:
                hold_back_signals()
    finally:
        release_signals()


def _open_closed_streams():
    """So that no file becomes a stream; writing results to them fails."""
    for descriptor, mode in enumerate((os.O_RDONLY, os.O_RDONLY, os.O_WRONLY)):
        try:
            os.fstat(descriptor)
        except OSError:
            os.set_inheritable(os.open(os.devnull, mode), True)
    sys.stdout = sys.stdout or open(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = sys.stderr or open(2, "w", encoding="utf-8", closefd=False)


def reason_of(error):
    """Without Python's number and quotes."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error) or "the memory does not suffice"


def tell(name, reason):
    with contextlib.suppress(OSError):
        print(f"{name}: {reason}", file=sys.stderr, flush=True)


def _status_of(name, main):
    try:
        main(sys.argv[1:])
        return 0
    except UsageError as error:
        tell(name, error)
        return BAD_USAGE
    except (OSError, ValueError, MemoryError) as error:
        tell(name, reason_of(error))
        return FAILURE
    except SystemExit as exit_:
        return exit_.code or 0


def _flushed(name, status):
    try:
        sys.stdout.flush()
        return status
    except OSError as error:
        tell(name, f"standard output could not be written: {error.strerror}")
        return status or FAILURE


def run(name, main):
    """Calls main(arguments) and ends the process."""
    _open_closed_streams()
    try:
        raise_when_stopped()
        # At once: what is left in a stream that failed is not to fail again.
        os._exit(_flushed(name, _status_of(name, main)))
    except Stopped as stopped:
        signal.signal(stopped.number, signal.SIG_DFL)
        release_signals()  # hold_back_signals() may raise it, too, when it has.
        os.kill(os.getpid(), stopped.number)


def _identity(path):
    """Of a regular file, existing or not; None of others."""
    try:
        status = os.stat(path)
        return (status.st_dev, status.st_ino) if os.path.isfile(path) else None
    except OSError:
        return os.path.realpath(path)


def refuse_overwriting(inputs, output):
    """[(name, path)] of what is read, and (name, path) of what is written. By any way to the file, as
    a standard stream too."""
    name, path = output
    streams = [("standard input", "/dev/fd/0"), ("standard error", "/dev/fd/2")]
    written = _identity("/dev/fd/1" if path == "-" else path)
    for other, read in inputs + (streams if path != "-" else []):
        if written is not None and written == _identity(read):
            raise UsageError(f"{name} would overwrite {other}, {path}; name another file")
