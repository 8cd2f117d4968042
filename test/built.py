# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The programs of a build, for tests of them as they are started: SCRIPT BIN [unittest arguments]"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

if len(sys.argv) < 2:
    sys.exit(sys.modules["__main__"].__doc__)
BIN = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[1]
DATA = ROOT / "test" / "data"
sys.path.insert(0, str(BIN.parent / "lcm_types" / "python"))
sys.dont_write_bytecode = True


def run(*command, status=0, **options):
    """The process, which ends with this status."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=300, check=False, **options)
    if done.returncode != status:
        raise AssertionError(f"{command}: status {done.returncode}\n{done.stdout[-2000:]}{done.stderr}")
    return done


def output_of(*command, **options):
    """All that it prints."""
    done = run(*command, **options)
    return done.stdout + done.stderr


def rows_of(path):
    """Of a CSV file, by column."""
    with open(path, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


class InFolder(unittest.TestCase):
    """Each test has an empty folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class InOneFolder(unittest.TestCase):
    """All tests of a class share one."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
