# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A file that is there when it is whole, and else as it was before."""
import contextlib
import os
import tempfile


@contextlib.contextmanager
def replaced_file(path):
    """To be written in place of `path`: it is renamed to that at the end, if nothing was raised."""
    with tempfile.NamedTemporaryFile(dir=os.path.dirname(os.path.abspath(path)), delete=False) as file:
        try:
            yield file
            os.chmod(file.name, 0o666 & ~umask())
            os.replace(file.name, path)
        except BaseException:
            os.unlink(file.name)
            raise


def umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
