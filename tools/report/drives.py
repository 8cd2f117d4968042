# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""From logs to pages: each drive by itself, several at once."""
import concurrent.futures
import hashlib
import json
import multiprocessing
import os
import pathlib
import signal
import sys
from dataclasses import dataclass, field

import main_program
import findings
import truth_findings
from drive_report import DriveReport
from heard_drive import HeardDrive
from index_page import Row, index
from logs import begun_at_once, named_logs
from page import data_of, page
from programs import errors_in, is_lcm, replay
from replaced_file import replaced_file
from truth_report import truth_data
from unconfigured import STANDARD, examined_configuration, is_unwritten

BAR_WIDTH = 40
ON_NO_BUS, NO_FRAME = "has no frame of interface", "no frame of this radar"  # As cremed says.
ONE_DRIVE = "several logs begin at the same time: are they the buses of one drive?"
MERGE = "`--merge` takes all logs as one drive"
# Of the time that a candump log takes.
REPLAY_PART = 0.8


@dataclass
class Drive:
    logs: list
    config: str = None
    truth: str = None
    truth_stds: list = field(default_factory=list)
    page: str = None  # Path; None: only the numbers are asked for.
    has_index: bool = False  # The page stands in a folder with one.
    is_begun_with_others: bool = False
    json: str = None
    figures: dict = field(default_factory=dict)
    troubles: list = field(default_factory=list)  # The page lacks what they say.
    findings: list = field(default_factory=list)
    truth_figures: list = None


def drives_of(arguments):
    named = list(named_logs(arguments.logs))
    is_one = arguments.merge or (len(named) == 1 and not os.path.isdir(arguments.logs[0]))
    groups = [([log for log, _ in named], "")] if is_one else [([log], name) for log, name in named]
    truths = arguments.truth + [None] * (len(groups) - len(arguments.truth))
    drives = [Drive(logs, arguments.config, truth, arguments.truth_std) for (logs, _), truth in zip(groups, truths)]
    for drive, begun in zip(drives, begun_at_once([log for log, _ in named])):
        drive.is_begun_with_others = begun and not arguments.merge
    if is_one and not arguments.output and not arguments.json:
        arguments.output = f"{named[0][1]}.html"
    for drive, (_, name) in zip(drives if arguments.output else (), groups):
        drive.page, drive.has_index = arguments.output, not is_one
        if not is_one:
            drive.page = os.path.join(arguments.output, f"{name}.html")
    return drives


def measure(drive, programs, told):
    """What the page shows. `told` is called with the part that is done."""
    with main_program.temporary_folder("cremed-report-") as name:
        folder, lcm_log, warnings, begun, found = pathlib.Path(name), drive.logs[0], [], 0.0, []
        is_candump, config = not is_lcm(drive.logs), drive.config
        if is_candump:
            begun = REPLAY_PART
            if not config and is_unwritten():
                config, missing = examined_configuration(programs, drive.logs, folder)
                found.append(missing)
            lcm_log, warnings, drive.troubles = replay(programs / "cremed", drive.logs, config, folder,
                                                       lambda part: told(REPLAY_PART * part))
        heard = heard_of(lcm_log, drive, lambda part: told(begun + 0.9 * (1 - begun) * part))
        if found:  # From which all else follows. That configuration is nobody's.
            warnings = [line.replace(f"--config {config} ", "") for line in warnings]
            drive.troubles = [f"{drive.logs[0]}: {found[0]['what']}; {found[0]['remedy']}"]
        data = {"logs": [os.path.basename(log) for log in drive.logs],
                "warnings": warnings or drive.troubles, **DriveReport(heard).data()}
        data["mounts_unknown"] = bool(found)
        data["findings"] = findings_of(drive, programs, data, found, is_candump)
        if drive.truth:
            of_truth = compare(drive, programs, data, heard, (lcm_log, folder))
            # What contradicts truth comes before all else; that nothing can be compared has a cause.
            is_compared = "truth" in data
            data["findings"] = of_truth + data["findings"] if is_compared else data["findings"] + of_truth
        data["findings"] = findings.in_order(data["findings"])
        told(1.0)
        return data


def compare(drive, programs, data, heard, places):
    """Adds what truth tells to the page; returns its findings. Without it the page goes on."""
    wrong, severity = "the log does not go on as it began", "note"
    remedy = "a log for each part, and truth in the same clock"
    if not data["breaks"]:
        try:
            data["truth"] = truth_data(programs, places[0], drive, heard, places[1])
            return truth_findings.of_truth(data["truth"], list(data["figures"]["radars"]))
        except ValueError as error:
            wrong, severity = str(error), "warning"
            remedy = ("the other findings tell why, or truth is not of this drive and clock, with the columns "
                      "utime,x_m,y_m,yaw_rad")
    wrong = f"there is no comparison with truth: {wrong}"
    drive.troubles.append(f"{drive.logs[0]}: {wrong}")
    return [findings.finding(severity, wrong, remedy)]


def findings_of(drive, programs, data, found, is_candump):
    """The doctor reads a candump log again, so it is asked only where cremed warned."""
    of_drive = findings.of_the_drive(data)
    if found:  # Without a configuration all else follows from that.
        return found
    if is_candump and data["warnings"]:
        of_doctor = findings.of_the_doctor(programs / "cremed-doctor", drive.logs, drive.config)
        found += findings.without_what_is_told(of_doctor, of_drive)
    if not any(one["severity"] == "error" for one in found):
        found += [findings.finding("error", error) for error in errors_in(drive.troubles)]
    if may_be_a_bus(drive):
        found.insert(0, findings.finding("error", ONE_DRIVE, MERGE))
    if not is_candump and of_drive:
        found.append(findings.of_messages())
    return findings.joined(found, of_drive, data["figures"]["radars"])


def may_be_a_bus(drive):
    """One of several of a drive: the others may have the radars that it lacks."""
    return drive.is_begun_with_others and any(text in trouble for trouble in drive.troubles for text in (ON_NO_BUS, NO_FRAME))


def heard_of(lcm_log, drive, told):
    is_elsewhere = any(ON_NO_BUS in trouble for trouble in drive.troubles)  # The doctor tells where.
    try:
        heard = HeardDrive(lcm_log, told, is_elsewhere)
    except ValueError as error:  # Its cause comes first.
        raise ValueError("\n".join(drive.troubles) or error) from error
    drive.troubles = drive.troubles or [trouble.replace(str(lcm_log), drive.logs[0]) for trouble in heard.troubles()]
    return heard


def made_of(drive):
    """What a page depends on beside the times of files; of a configuration the content."""
    try:
        config = hashlib.sha256(pathlib.Path(drive.config or STANDARD).read_bytes()).hexdigest()
    except OSError:  # cremed says what is wrong.
        config = None
    return {"config": config, "truth": drive.truth is not None, "truth_std": drive.truth_stds}


def make(drive, programs, share, version, told):
    data = {"version": version, "made_of": made_of(drive), **measure(drive, programs, told)}
    data["troubles"] = drive.troubles
    if drive.page:
        with replaced_file(drive.page) as file:
            file.write(page(data, share).encode("utf-8", "replace"))
    take_figures(drive, data)
    numbers = {name: value for name, value in data.items() if name != "scans"}
    drive.json = json.dumps(numbers, allow_nan=False) + "\n"
    return drive


def take_figures(drive, data):
    drive.figures, drive.findings, drive.troubles = data["figures"], data["findings"], data["troubles"]
    drive.truth_figures = data["truth"]["figures"] if "truth" in data else None


def is_made(drive, version):
    """Whether an earlier run has made the page, by the same version, of these files."""
    inputs = [*drive.logs, *filter(None, (drive.config, drive.truth))]
    try:
        if os.path.getmtime(drive.page) < max(map(os.path.getmtime, inputs)):
            return False
        data = data_of(drive.page)
    except (OSError, ValueError, TypeError):
        return False
    if data.get("version") != version or data.get("made_of") != made_of(drive):
        return False
    take_figures(drive, data)
    return True


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
        reason = main_program.reason_of(error)
        return reason if reason.startswith(drive.logs[0]) else f"{', '.join(drive.logs)}: {reason}"
    finally:
        PROGRESS.parts[number] = 1.0


def stop_at_once():
    """A process of the pool, while it waits."""
    for number in main_program.SIGNALS:
        signal.signal(number, signal.SIG_DFL)
    main_program.release_signals()  # make_at_once() holds them back.


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
            main_program.hold_back_signals()  # What is raised while a process is forked is lost.
            results = [pool.submit(make_one_apart, number, drive, *arguments)
                       for number, drive in enumerate(drives)]
            main_program.release_signals()
            while concurrent.futures.wait(results, 0.2).not_done:
                PROGRESS.show()
            return [result.result() for result in results]
        except concurrent.futures.BrokenExecutor as error:
            raise ValueError("a process was killed; fewer --jobs need less memory") from error
        except main_program.Stopped:
            for child in multiprocessing.active_children():
                child.terminate()
            raise


def index_folder(drives):
    """Where several pages go; nothing for one page, or none."""
    return os.path.dirname(drives[0].page) if drives[0].page and drives[0].has_index else None


def make_pages(drives, programs, share, jobs, version, resume=False):
    """Returns the drives that could be made; what is wrong is printed."""
    global PROGRESS  # pylint: disable=global-statement
    folder = index_folder(drives)
    if folder:
        os.makedirs(folder, exist_ok=True)
    old = [drive for drive in drives if resume and is_made(drive, version)]
    new = [drive for drive in drives if drive not in old]
    PROGRESS = Progress(len(new))
    arguments = programs, share, version
    try:
        results = (make_at_once(new, jobs, *arguments) if len(new) > 1 else
                   [make_one(number, drive, *arguments) for number, drive in enumerate(new)])
    finally:
        PROGRESS.wipe()
    made = [result for result in results if isinstance(result, Drive)]
    for result in old + results:
        for trouble in result.troubles if isinstance(result, Drive) else [result]:
            is_named = len(drives) == 1 or not isinstance(result, Drive) or trouble.startswith(result.logs[0])
            main_program.tell("cremed-report", trouble if is_named else f"{result.logs[0]}: {trouble}")
    if any(isinstance(result, Drive) and may_be_a_bus(result) for result in old + results):
        main_program.tell("cremed-report", f"{ONE_DRIVE} {MERGE}")
    if len(made) < len(new) and len(drives) > 1:
        main_program.tell("cremed-report", f"{len(new) - len(made)} of {len(drives)} drives have no report")
    if folder:
        rows = [Row.of(result) if isinstance(result, Drive) else Row(drive.logs[0], failure=result)
                for drive, result in [*zip(new, results), *((drive, drive) for drive in old)]]
        with replaced_file(os.path.join(folder, "index.html")) as file:
            file.write(index(rows, share).encode("utf-8", "replace"))
    return old + made
