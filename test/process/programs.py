# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""The programs of the process matrix with their inputs and outputs."""
import dataclasses
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIG = ROOT / "test" / "data" / "bends.toml"
LOG = ROOT / "test" / "data" / "bends.log"
DYGRAPHS = pathlib.Path("/usr/share/javascript/dygraphs")  # Of cremed-report.

PAIRS = "".join(
    f"T,{pair},0.1,0,0,0.1\n" + "".join(
        f"D,{pair},{scan},{i},{10 + i - 0.1 * scan},{0.3 * (i - 1)},-1,0.1,0.01,0.1\n"
        for i in range(3) for scan in (0, 1)) for pair in range(200))


@dataclasses.dataclass(frozen=True)
class Program:
    """A command line; {in} is its input, {out} and {out2} its outputs, others are Files."""
    name: str
    line: str
    source: str = ""        # Name of its input file; empty: none.
    prints: bool = False    # Results on standard output.
    stops: bool = False     # Ends in order at a signal; others are killed by it.
    status: int = 0         # With a good input.
    is_timed: bool = False  # It prints its duration.
    at_once: bool = False   # Its outputs appear when they are complete.
    again_lines: int = 1    # Lines at the end of its input that may repeat; 0: all.
    cut_statuses: tuple = (0, 1)  # With half of the input.
    pipes: bool = True      # Its input may be a pipe.
    last: bytes = b""       # What its output ends with; empty: lines of as many cells each.

    def command(self, folder, files, **named):
        places = {key: str(value) for key, value in {**files, **named}.items()}
        places.setdefault("out", f"{folder}/out")
        places.setdefault("out2", f"{folder}/out2")
        places.setdefault("in", places.get(self.source, ""))
        program, *arguments = self.line.split()
        return [program, *(argument.format(**places) for argument in arguments)]

    def endless(self, files):
        """Its input, and the part that may repeat."""
        content = pathlib.Path(files[self.source]).read_bytes()
        return content, b"".join(content.splitlines(True)[-self.again_lines:])

    def is_whole(self, path):
        """An output: complete."""
        text = path.read_bytes()
        if self.last:
            return text == b"" or text.endswith(self.last)
        cells = {len(line.replace(b",", b" ").split(b" ")) for line in text.splitlines()}
        return (text == b"" or text.endswith(b"\n")) and len(cells) <= 1

    def outputs(self):
        return [name for name in ("out", "out2") if f"{{{name}}}" in self.line]


REPLAY = Program("replay", "cremed --config {config} --lcm-url none --replay {in} --output-csv {out}"
                 " --output-tum {out2}", "log", stops=True)
ODOMETRY = Program("replay of the state", "cremed --config {config} --lcm-url none --replay {in}"
                   " --output-odometry {out}", "log", stops=True)
CHECK = Program("check of a configuration", "cremed --check-config {config}", prints=True)
HELP = Program("help", "cremed --help", prints=True)
DOCTOR = Program("doctor of a log", "cremed-doctor --config {config} --replay {in}", "log",
                 prints=True, status=None)
DUMP = Program("dump", "cremed-dump {in} --config {config} --json --no-targets", "log", prints=True,
               status=None)
SIMULATE = Program("simulate", "cremed-simulate --scenario bends --duration 4 --output {out}"
                   " --truth {out2}")
SIMULATE_OUT = Program("simulate to standard output",
                       "cremed-simulate --scenario bends --duration 4 --output -", prints=True)
LCM_TO_CSV = Program("lcm-to-csv", "cremed-lcm-to-csv {in} --output {out} --odometry {out2}", "lcm",
                     again_lines=0)
PAIRS_OF = Program("eval pairs", "cremed-laboratory pairs {in} --profile sim --output {out}", "pairs",
                   prints=True, is_timed=True, at_once=True, again_lines=7)
DRIVE = Program("eval drive", "cremed-eval drive {in} {truth} --truth-tum {out}", "odometry",
                prints=True, at_once=True)
CALIBRATE = Program("eval calibrate", "cremed-eval calibrate {in} --config {config}", "log",
                    prints=True)
TABLE = Program("eval table", "cremed-laboratory table --runs 1 --sets 1 --threads 1", prints=True,
                is_timed=True)

BENCH = Program("bench", "cremed-bench --benchmark_min_time=0.001 --benchmark_filter=components/16",
                prints=True, is_timed=True)  # Needs libbenchmark-dev.
CONVERT = Program("convert mcap", "cremed-convert mcap {in} {out}", "lcm", at_once=True, again_lines=0,
                  last=b"\x89MCAP0\r\n")
REPORT = Program("report", "cremed-report {in} --config {config} --output {out} --json", "lcm",
                 prints=True, at_once=True, again_lines=0, pipes=False, last=b"</html>\n")

ALL = (REPLAY, ODOMETRY, CHECK, HELP, DOCTOR, DUMP, SIMULATE, SIMULATE_OUT, LCM_TO_CSV, PAIRS_OF, DRIVE, CALIBRATE,
       TABLE, BENCH, CONVERT, *([REPORT] if DYGRAPHS.exists() else []))
WITH_INPUT = tuple(program for program in ALL if program.source)
WITH_PIPE = tuple(program for program in WITH_INPUT if program.pipes)
WITH_OUTPUT = tuple(program for program in ALL if program.outputs())


def make_files(binaries, folder):
    """The inputs of all programs, by name."""
    files = {"config": CONFIG, "log": LOG, "lcm": folder / "log.lcm", "pairs": folder / "pairs",
             "odometry": folder / "odometry.csv", "truth": folder / "truth.csv"}
    files["pairs"].write_text(PAIRS)
    drive = folder / "drive.log"
    for line in (f"cremed-simulate --scenario bends --duration 8 --config {CONFIG} --output {drive}"
                 f" --truth {files['truth']}",
                 f"cremed --config {CONFIG} --replay {drive} --lcm-url file://{files['lcm']}?mode=w"
                 f" --output-csv {files['odometry']}"):
        program, *arguments = line.split()
        subprocess.run([binaries / program, *arguments], check=True, capture_output=True)
    return files
