# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed and cremed-eval, which the report's numbers come from."""
import csv
import json
import os
import pathlib
import re
import subprocess

MAGIC_LCM = bytes.fromhex("EDA1DA01")
SAID = "cremed said:\n"


def is_lcm_log(path):
    with open(path, "rb") as file:
        return file.read(4) == MAGIC_LCM


def is_lcm(paths):
    for path in paths:
        if os.path.exists(path) and not os.path.isfile(path):
            raise ValueError(f"{path}: is no file; a report reads its log more than once")
    kinds = {is_lcm_log(path) for path in paths}
    if kinds == {True} and len(paths) > 1:
        raise ValueError("several LCM logs cannot be one drive: --merge is for candump logs")
    if len(kinds) > 1:
        raise ValueError("candump and LCM logs cannot be one drive")
    return kinds == {True}


def part_read(process, paths):
    """How much of its logs a process has read, as the kernel tells."""
    done = 0
    for link in pathlib.Path(f"/proc/{process.pid}/fd").glob("*"):
        try:
            if os.readlink(link) in paths:
                text = pathlib.Path(f"/proc/{process.pid}/fdinfo/{link.name}").read_text(encoding="ascii")
                done += int(text.split()[1])
        except OSError:  # Closed since.
            pass
    return done / max(sum(os.path.getsize(path) for path in paths), 1)


def errors_of(said):
    """The errors, each with the lines that go on with it."""
    errors, is_error = [], False
    for line in said:
        if re.match("(error|warning|info): ", line):
            is_error = line.startswith("error: ")
        if is_error:
            errors.append(line)
    return errors


def errors_in(troubles):
    """One by one, without what tells a terminal that they are errors of cremed."""
    return [error for trouble in troubles for error in re.split("(?:^|\n)error: ", trouble.removeprefix(SAID)) if error]


def replays(logs):
    """As arguments of cremed and of the doctor."""
    return [word for log in logs for word in ("--replay", log)]


def has_ended(process, within_s):
    try:
        process.wait(within_s)
        return True
    except subprocess.TimeoutExpired:
        return False


def replay(cremed, logs, config, folder, told):
    """Runs candump logs through cremed; returns the LCM log, what cremed warned of, and its errors where
    it failed: the log has what is good, unless the disk was full. `told` is called with the part that is done."""
    lcm_log, words = folder / "heard.lcm", folder / "words"
    command = [cremed, "--publish-scans", "--lcm-url", f"file://{lcm_log}?mode=w"]
    command += ["--config", config] if config else []
    command += replays(logs)
    paths = {os.path.realpath(log) for log in logs}
    with open(words, "wb") as file, subprocess.Popen(command, stdin=subprocess.DEVNULL,
                                                     stdout=file, stderr=file) as process:
        try:
            while not has_ended(process, 0.2):
                told(part_read(process, paths))
        except BaseException:
            process.kill()
            raise
    told(1.0)
    said = words.read_text(encoding="utf-8", errors="replace").splitlines()
    troubles = []
    if process.returncode != 0:
        errors = errors_of(said) or said[-5:]
        troubles = [SAID + "\n".join(errors)]
        if not lcm_log.exists() or any("could not be written" in error for error in errors):
            raise ValueError(*troubles)
    return lcm_log, [line for line in said if not line.startswith("info: ")], troubles


def run(command, statuses=(0,)):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          errors="replace", check=False)
    if done.returncode not in statuses:
        raise ValueError(done.stderr.strip() or f"{command[0]} failed")
    return done.stdout


def read_table(path):
    """{source: {column: numbers}}; where there is no source all is that of ""."""
    table = {}
    with open(path, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            columns = table.setdefault(row.pop("source", ""), {})
            for name, text in row.items():
                columns.setdefault(name, []).append(float(text))
    return table


def evaluate(programs, lcm_log, drive, folder):
    """(figures, errors, drift) of all sources against truth, those of the odometry first, and truth's gaps."""
    motions, states = folder / "motions.csv", folder / "states.csv"
    # It fails where the log is damaged, which the report says already.
    run([programs / "cremed-lcm-to-csv", lcm_log, "--output", motions, "--odometry", states], (0, 1))
    stds = [word for std in drive.truth_stds for word in ("--truth-std", std)]
    figures, errors, drift = [], {}, {}
    for rows in states, motions:
        tables = folder / rows.stem
        tables.mkdir()
        try:
            told = run([programs / "cremed-eval", "drive", rows, drive.truth, "--json", "--tables", tables,
                        *stds])
        except ValueError as error:  # It knows the temporary file only.
            why = str(error).splitlines()[-1].removeprefix(f"cremed-eval: {rows}: ").replace(str(rows), drive.logs[0])
            raise ValueError(why) from error
        told = json.loads(told)
        figures += told["sources"]
        errors |= read_table(tables / "errors.csv")
        drift |= read_table(tables / "drift.csv")
    return figures, errors, drift, told["truth_gaps"]


def read_poses(path):
    """[(utime, x_m, y_m, yaw_rad)] of truth."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        return [tuple(float(row[name]) for name in ("utime", "x_m", "y_m", "yaw_rad"))
                for row in csv.DictReader(file)]
