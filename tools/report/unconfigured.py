# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A report for one who has a log and no configuration: each radar by itself, as mounts are not known."""
import pathlib

from findings import finding
from programs import replays, run

STANDARD = pathlib.Path("/etc/cremed/cremed.toml")
# As cremed-doctor examines them: without a mount there is no common odometry, and the motion is free.
EXAMINED = "odometry.enabled = false\nestimator.degrees_of_freedom = 3\n"
MOUNT_UNKNOWN = '"FILL IN"'


def is_unwritten(path=STANDARD):
    """Absent, or as the package installs it: comments only."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return True
    except (OSError, UnicodeDecodeError):
        return False  # cremed says what is wrong.
    return all(not line.strip() or line.strip().startswith("#") for line in lines)


def examined_configuration(programs, logs, folder):
    """(the file, the finding that tells of it): of the radars that the doctor recognises in the log."""
    suggestion = run([programs / "cremed-doctor", *replays(logs), "--suggest-config"])
    path = folder / "examined.toml"
    path.write_text(EXAMINED + suggestion.replace(MOUNT_UNKNOWN, "0"), encoding="utf-8")
    replayed, reported = ("--replay LOG", "LOG") if len(logs) == 1 else ("--replay LOG --replay LOG ...", "--merge LOG LOG ...")
    return str(path), finding(
        "error", "there is no configuration: the radars are those recognised in the log, and their mounts unknown, "
        "so there is no odometry", f"`cremed-doctor {replayed} --suggest-config > my.toml` writes a first one; fill in "
        f"the mounts, then `cremed-report {reported} --config my.toml --output report.html`")
