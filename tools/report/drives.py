# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""From logs to pages: each drive by itself, several at once."""
import concurrent.futures
import json
import multiprocessing
import os
import pathlib
import signal
import sys
from dataclasses import dataclass, field

import main_program
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
    troubles: list = field(default_factory=list)  # The page lacks what they say.


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
    with main_program.temporary_folder("cremed-report-") as name:
        folder, lcm_log, warnings, begun = pathlib.Path(name), drive.logs[0], [], 0.0
        if not is_lcm(drive.logs):
            begun = REPLAY_PART
            lcm_log, warnings, drive.troubles = replay(programs / "cremed", drive.logs, drive.config, folder,
                                                       lambda part: told(REPLAY_PART * part))
        heard = heard_of(lcm_log, drive, lambda part: told(begun + 0.9 * (1 - begun) * part))
        data = {"logs": [os.path.basename(log) for log in drive.logs],
                "warnings": warnings or drive.troubles, **DriveReport(heard).data()}
        if drive.truth:
            data["truth"] = truth_data(programs, lcm_log, drive, heard, folder)
        told(1.0)
        return data


def heard_of(lcm_log, drive, told):
    try:
        heard = HeardDrive(lcm_log, told)
    except ValueError as error:  # Its cause comes first.
        raise ValueError("\n".join(drive.troubles) or error) from error
    drive.troubles = drive.troubles or heard.troubles()
    return heard


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
    """How much of each drive is done; a bar, if standard error is a terminal."""

    def __init__(self, count):
        self.is_shared = count > 1  # By processes.
        self.parts = multiprocessing.Array("d", count) if self.is_shared else [0.0]
        self.is_shown = sys.stderr.isatty()

    def teller(self, number):
        def tell(part):
            self.parts[number] = part
            if not self.is_shared:
                self.show()
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
    """What failed is a text: all others go on."""
    try:
        return make(drive, programs, share, version, PROGRESS.teller(number))
    except (OSError, ValueError, MemoryError) as error:
        return f"{', '.join(drive.logs)}: {error or 'the memory does not suffice'}"
    finally:
        PROGRESS.parts[number] = 1.0


def stop_at_once():
    """A process of the pool, while it waits."""
    for number in main_program.SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def make_one_apart(*arguments):
    """In a process of the pool."""
    main_program.raise_when_stopped()
    try:
        return make_one(*arguments)
    except main_program.Stopped:
        os._exit(main_program.FAILURE)
    finally:
        stop_at_once()


def make_at_once(drives, jobs, *arguments):
    """What make_one returns, in order."""
    context = multiprocessing.get_context("fork")
    with concurrent.futures.ProcessPoolExecutor(min(jobs, len(drives)), context, stop_at_once) as pool:
        try:
            results = [pool.submit(make_one_apart, number, drive, *arguments)
                       for number, drive in enumerate(drives)]
            while concurrent.futures.wait(results, 0.2).not_done:
                PROGRESS.show()
            return [result.result() for result in results]
        except concurrent.futures.BrokenExecutor as error:
            raise ValueError("a process was killed; fewer --jobs need less memory") from error
        except main_program.Stopped:
            for child in multiprocessing.active_children():
                child.terminate()
            raise


def make_pages(drives, programs, share, jobs, version):
    """Returns the drives that could be made; what is wrong is printed."""
    global PROGRESS  # pylint: disable=global-statement
    PROGRESS = Progress(len(drives))
    if len(drives) > 1 and drives[0].page:
        os.makedirs(os.path.dirname(drives[0].page), exist_ok=True)
    arguments = programs, share, version
    try:
        results = (make_at_once(drives, jobs, *arguments) if len(drives) > 1 else
                   [make_one(0, drives[0], *arguments)])
    finally:
        PROGRESS.wipe()
    made = [result for result in results if isinstance(result, Drive)]
    for result in results:
        for trouble in result.troubles if isinstance(result, Drive) else [result]:
            main_program.tell("cremed-report", trouble)
    if len(made) < len(drives) > 1:
        main_program.tell("cremed-report", f"{len(drives) - len(made)} of {len(drives)} drives have no report")
    if len(drives) > 1 and drives[0].page:
        with replaced_file(os.path.join(os.path.dirname(drives[0].page), "index.html")) as file:
            file.write(index(made).encode())
    return made
