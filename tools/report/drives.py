# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""From logs to pages: each drive by itself, several at once."""
import concurrent.futures
import json
import multiprocessing
import os
import pathlib
import sys
import tempfile
from dataclasses import dataclass, field

from drive_report import DriveReport
from heard_drive import HeardDrive
from page import index, page
from programs import is_lcm, replay
from replaced_file import replaced_file
from truth_report import truth_data

BAR_WIDTH = 40
# Of the time that a candump log takes.
REPLAY_PART = 0.8


@dataclass
class Drive:
    logs: list
    config: str = None
    truth: str = None
    truth_stds: list = field(default_factory=list)
    page: str = None  # Path; None: only the numbers are asked for.
    json: str = None
    figures: dict = field(default_factory=dict)


def drives_of(arguments):
    groups = [arguments.logs] if arguments.merge else [[log] for log in arguments.logs]
    truths = arguments.truth + [None] * (len(groups) - len(arguments.truth))
    drives = [Drive(logs, arguments.config, truth, arguments.truth_std) for logs, truth in zip(groups, truths)]
    for drive in drives if arguments.output else ():
        name = pathlib.Path(drive.logs[0]).stem + ".html"
        drive.page = os.path.join(arguments.output, name) if len(drives) > 1 else arguments.output
    return drives


def measure(drive, programs, told):
    """What the page shows. `told` is called with the part that is done."""
    with tempfile.TemporaryDirectory(prefix="cremed-report-") as name:
        folder, lcm_log, warnings, begun = pathlib.Path(name), drive.logs[0], [], 0.0
        if not is_lcm(drive.logs):
            begun = REPLAY_PART
            lcm_log, warnings = replay(programs / "cremed", drive.logs, drive.config, folder,
                                       lambda part: told(REPLAY_PART * part))
        heard = HeardDrive(lcm_log, lambda part: told(begun + 0.9 * (1 - begun) * part))
        data = {"logs": [os.path.basename(log) for log in drive.logs], "warnings": warnings,
                **DriveReport(heard).data()}
        if drive.truth:
            data["truth"] = truth_data(programs, lcm_log, drive, heard, folder)
        told(1.0)
        return data


def make(drive, programs, share, version, told):
    data = {"version": version, **measure(drive, programs, told)}
    if drive.page:
        with replaced_file(drive.page) as file:
            file.write(page(data, share).encode())
    drive.figures = data["figures"]
    numbers = {name: value for name, value in data.items() if name != "scans"}
    drive.json = json.dumps(numbers, allow_nan=False) + "\n"
    return drive


class Progress:
    """How much of each drive is done, shared by processes; a bar, if standard error is a terminal."""

    def __init__(self, count):
        self.parts = multiprocessing.Array("d", count)
        self.is_shown = sys.stderr.isatty()

    def teller(self, number):
        def tell(part):
            self.parts[number] = part
        return tell

    def show(self):
        if self.is_shown:
            part = sum(self.parts) / len(self.parts)
            bar = "#" * int(BAR_WIDTH * part)
            print(f"\r{'report':20} [{bar:{BAR_WIDTH}}] {100 * part:3.0f} %", end="", file=sys.stderr,
                  flush=True)

    def wipe(self):
        if self.is_shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


PROGRESS = None  # Of this run; processes that are forked share it.


def make_one(number, drive, programs, share, version):
    """In a process of its own. What failed is a text: all others go on."""
    try:
        return make(drive, programs, share, version, PROGRESS.teller(number))
    except (OSError, ValueError) as error:
        return f"{', '.join(drive.logs)}: {error}"
    finally:
        PROGRESS.parts[number] = 1.0


def make_pages(drives, programs, share, jobs, version):
    """Returns the drives that could be made; what is wrong with others is printed."""
    global PROGRESS  # pylint: disable=global-statement
    PROGRESS = Progress(len(drives))
    if len(drives) > 1 and drives[0].page:
        os.makedirs(os.path.dirname(drives[0].page), exist_ok=True)
    context = multiprocessing.get_context("fork")
    with concurrent.futures.ProcessPoolExecutor(min(jobs, len(drives)), context) as pool:
        results = [pool.submit(make_one, number, drive, programs, share, version)
                   for number, drive in enumerate(drives)]
        while concurrent.futures.wait(results, 0.2).not_done:
            PROGRESS.show()
    PROGRESS.wipe()
    made = []
    for result in results:
        if isinstance(result.result(), Drive):
            made.append(result.result())
        else:
            print(f"cremed-report: {result.result()}", file=sys.stderr)
    if len(made) < len(drives) > 1:
        print(f"cremed-report: {len(drives) - len(made)} of {len(drives)} drives have no report",
              file=sys.stderr)
    if len(drives) > 1 and drives[0].page:
        with replaced_file(os.path.join(os.path.dirname(drives[0].page), "index.html")) as file:
            file.write(index(made).encode())
    return made
