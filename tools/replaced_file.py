# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A file that is there when it is whole, and else as it was before."""
import contextlib
import errno
import os
import stat
import tempfile

from main_program import hold_back_signals, release_signals

STANDARD_OUTPUT = ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")
USUAL_PERMISSIONS = 0o644


@contextlib.contextmanager
def replaced_file(path):
    """To be written in place of `path`: what it links to is replaced at the end, if nothing was raised.
    A device, a pipe and standard output are written to. Errors name `path`."""
    try:
        with _written_to(path) if _is_stream(path) else _replaced(os.path.realpath(path)) as file:
            yield file
    except OSError as error:
        if error.filename is not None:  # Of another file.
            raise
        name = "standard output" if path == "-" else path
        # With a name, although of nothing: a file that is written beside this one must not claim the error.
        raise OSError(error.errno, f"cannot write {name}: {error.strerror or error}", "") from error


def _is_stream(path):
    if str(path) in STANDARD_OUTPUT:
        return True
    try:
        return not stat.S_ISREG(os.stat(path).st_mode)
    except OSError:
        return False


@contextlib.contextmanager
def _nameless():
    """Errors of what nobody named lose their name."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror) from error


@contextlib.contextmanager
def _written_to(path):
    with _nameless():
        file = open(os.dup(1) if str(path) in STANDARD_OUTPUT else path, "wb")
    with file:
        yield file


@contextlib.contextmanager
def _replaced(target):
    part = None
    hold_back_signals()
    try:
        with _nameless():
            permissions = _permissions(target)
            descriptor, part = tempfile.mkstemp(prefix=f"{os.path.basename(target)}.", dir=os.path.dirname(target))
        release_signals()
        with open(descriptor, "wb") as file:
            yield file
            with _nameless():
                file.flush()
                permissions(descriptor)
                os.replace(part, target)
    except BaseException:
        if part:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(part)
        raise
    finally:
        release_signals()


def _permissions(target):
    """What gives a new file those of the old; raises, where that may not be written, which renaming would
    not check."""
    if not os.path.exists(target):
        return lambda file: os.fchmod(file, USUAL_PERMISSIONS)
    if not os.access(target, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))
    of_old = os.stat(target)

    def give(file):
        os.fchmod(file, stat.S_IMODE(of_old.st_mode))
        with contextlib.suppress(PermissionError):  # Only root may change the owner.
            os.fchown(file, of_old.st_uid, of_old.st_gid)
    return give
