# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs scenarios, several at a time, each in a network namespace with its own buses."""
import argparse
import bisect
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import traceback

from can_bus import SPEED_STEP_MPS, CanBus, RadarPlayer, ip
from lcm_listener import LcmListener
from live_daemon import FRONT, REAR, Failure, LiveDaemon, Skipped, check, radar, wait_until

SCENARIOS = {}
LIMIT_S = 120
PASSED, FAILED, SKIPPED = 0, 1, 77
# A message is judged before it is sent; the guest has one processor for all.
SLOWEST_SENDING_S = 0.1
# On an idle computer it ends in hundredths of a second; the guest shares the processors with other work.
SLOWEST_END_S = 5


def scenario(function=None, owns_kernel=False):
    """Registers a scenario. `owns_kernel`: it changes state shared by all namespaces, so it runs
    alone, and only in a guest."""
    if function is None:
        return lambda function: scenario(function, owns_kernel)
    function.owns_kernel = owns_kernel
    SCENARIOS[function.__name__] = function
    return function


def expect_estimates(listener, sources):
    """Waits for three more estimates of each source; returns the delay of the first."""
    begin_s = time.monotonic()
    for source in sources:
        wait_until(lambda s=source: len(listener.estimates(s, begin_s)) >= 3,
                   f"three estimates of {source}")
    return listener.estimates(sources[0], begin_s)[0].monotonic_s - begin_s


def is_of(motion, speed_mps):
    """The speed, as sent on the bus, is this estimate's."""
    estimate_mps = motion.x_in_start_frame_m / (motion.utime - motion.utime_start) * 1e6
    return abs(speed_mps - estimate_mps) < SPEED_STEP_MPS


class Vehicle:
    """The means of a scenario."""

    def __init__(self, arguments, folder):
        self.bin = pathlib.Path(arguments.bin)
        self.folder = pathlib.Path(folder)
        self.folder.chmod(0o755)
        self.listener = None
        self.daemons = []
        self.taken_us = []  # When a scenario took the processor from the daemon.

    def bus(self, name):
        return CanBus(name).create()

    def log(self, name):
        return simulate(self.bin / "cremed-simulate", name, self.folder)

    def radar(self, bus, log="field"):
        return RadarPlayer(bus, self.log(log))

    def start(self, configuration=FRONT, **options):
        self.listener = self.listener or LcmListener()
        folder = tempfile.mkdtemp(dir=self.folder)
        os.chmod(folder, 0o755)
        daemon = LiveDaemon(folder, self.bin / "cremed", configuration, **options)
        self.daemons.append(daemon)
        return daemon

    def expect_odometry(self, *sources):
        return expect_estimates(self.listener, sources)

    def is_fresh(self, utime_us, seen_us, left_us):
        """At most max_latency_s old when its age was judged. `seen_us`: the kernel's stamp of receiving it;
        `left_us`: those of all that was sent, in order. No process can judge and send in one: if the
        processor was taken since whatever was sent before, it was judged until then."""
        before_us = left_us[max(bisect.bisect_left(left_us, seen_us) - 1, 0)]
        judged_us = max((taken_us for taken_us in self.taken_us
                         if max(utime_us, before_us) < taken_us < seen_us), default=seen_us)
        limit_s = max(daemon.max_latency_s for daemon in self.daemons) + SLOWEST_SENDING_S
        return judged_us - utime_us < limit_s * 1e6

    def expect_speeds_are_fresh(self, speeds):
        """Each speed that motion_feedback put on the bus is of an estimate that was fresh then; in their
        order, each once."""
        check(speeds, "motion_feedback is sent")
        motions = iter(self.motions_until(speeds[-1][0]))
        left_us = sorted([heard.wall_us for heard, _ in self.heard()] + [sent_us for sent_us, _ in speeds])
        for sent_us, speed_mps in speeds:
            check(any(motion.utime < sent_us and self.is_fresh(motion.utime, sent_us, left_us)
                      and is_of(motion, speed_mps) for motion in motions),
                  f"{speed_mps:.2f} m/s on the bus is an estimate of now")

    def motions_until(self, stamp_us):
        """Estimates of front. On a busy computer the listener is behind the bus: waits for it."""
        def heard():
            return [heard.message for heard in self.listener.estimates("front")]
        return wait_until(lambda: [m for m in heard() if m.utime > stamp_us] and heard(),
                          "an estimate after the last speed")

    def heard(self):
        """All messages, with their channels."""
        return [(heard, channel) for channel, messages in self.listener.heard.items()
                for heard in list(messages)]

    def expect_nothing_stale(self):
        """Whatever was published, but for statuses; returns the greatest age."""
        ages_s = [0.0]
        all_heard = self.heard()
        left_us = sorted(heard.wall_us for heard, _ in all_heard)
        for heard, channel in all_heard:
            if channel == "CREMED_STATUS":
                continue  # Counters: the last known are sent at once when LCM is connected.
            check(self.is_fresh(heard.message.utime, heard.wall_us, left_us),
                  f"nothing stale; {channel} is {heard.age_s:.2f} s old")
            ages_s.append(heard.age_s)
        return max(ages_s)

    def expect_good_manners(self, repeated=()):
        """Checks for every scenario: nothing stale, nothing logged twice, a clean end. `repeated`:
        words of lines that may repeat."""
        self.expect_nothing_stale()
        for daemon in self.daemons:
            # On a busy computer it may lose frames, wait, or read a bus too late more than once.
            late = [line for line in daemon.lines if "no frame is read in time" in line]
            good_again = [f"{line.split(': ')[1]}: good again" for line in late]
            told = [line for line in daemon.lines
                    if not any(word in line for word in (*repeated, *late, *good_again, "losses", "delay"))]
            twice = {line for line in told if told.count(line) > 1}
            check(not twice, f"each condition logged once, not {sorted(twice)}")
            if daemon.process.poll() is None:
                status, took_s = daemon.stop()
                check(status == 0, f"exit status 0 after SIGTERM, not {status}")
                check(took_s < SLOWEST_END_S,
                      f"an end within {SLOWEST_END_S} s, not {took_s:.2f} s")


# In the field are few targets: the frames of others fill a slow guest's processor.
DRIVES = {  # Name: scenario, seconds, radars.
    "field": ("field", 15, FRONT + REAR),
    "long": ("field", 60, FRONT),
    "straight": ("straight", 60, FRONT),
    "one-bus": ("field", 15,
                FRONT + radar("corner", "vcan0", "sensor_id = 3", x_m=3.4, yaw_rad=-0.6)),
}


def simulate(program, name, folder):
    """Returns the log of a drive."""
    log, toml = folder / f"{name}.log", folder / f"{name}.toml"
    scenario_name, duration_s, configuration = DRIVES[name]
    toml.write_text(configuration)
    subprocess.run([program, "--scenario", scenario_name, "--duration", str(duration_s),
                    "--config", toml, "--output", log], check=True)
    return log


RECEIVE_LIMIT = "net.core.rmem_max=1048576"  # As cremed-receive-buffer.service has it.


def set_receive_limit(setting):
    """The setting is shared by all namespaces and visible in the first only."""
    subprocess.run(["nsenter", "--net", "--target", "1", "sysctl", "--quiet", setting], check=True)


def run_one(arguments):
    """In the scenario's own process and namespace."""
    ip("link", "set", "lo", "up")
    ip("route", "add", "239.255.76.67/32", "dev", "lo")
    with tempfile.TemporaryDirectory(prefix="cremed-scenario-") as folder:
        vehicle = Vehicle(arguments, folder)
        begin_s, status, verdict = time.monotonic(), FAILED, "PASS"
        try:
            SCENARIOS[arguments.scenario](vehicle)
            status = PASSED
        except Failure as failure:
            verdict = f"FAIL: {failure}"
        except Skipped as skipped:
            status, verdict = SKIPPED, f"SKIPPED: {skipped}"
        except Exception:  # pylint: disable=broad-except
            verdict = f"FAIL: {traceback.format_exc()}"
        print(f"{arguments.scenario}: {verdict} ({time.monotonic() - begin_s:.1f} s)")
        for daemon in vehicle.daemons:
            if status == FAILED:
                print("    log:", *daemon.lines, sep="\n      ")
                print("    STATUS:", daemon.status_text())
            if daemon.process.poll() is None:
                daemon.process.kill()
    sys.stdout.flush()
    # Listeners, players and readers are still waiting.
    os._exit(status)


def run_in_namespace(arguments, name):
    command = ["unshare", "--net", sys.executable, sys.argv[0], arguments.bin, "--scenario", name]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", timeout=LIMIT_S, check=False)
    except subprocess.TimeoutExpired as expired:
        print(f"{name}: FAIL: not done within {LIMIT_S} s\n{expired.output}", flush=True)
        return FAILED
    print(done.stdout, end="", flush=True)
    return done.returncode


def run_all(arguments):
    names = [name for name in SCENARIOS if arguments.only in name]
    alone = [name for name in names if SCENARIOS[name].owns_kernel]
    if os.environ.get("CREMED_KERNEL") != "guest":
        print(*[f"{name}: SKIPPED: it would change this computer" for name in alone], sep="\n")
        names, alone = [name for name in names if name not in alone], []
    else:
        set_receive_limit(RECEIVE_LIMIT)

    def run(name):
        return run_in_namespace(arguments, name)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(run, [name for name in names if name not in alone]))
    results += [run(name) for name in alone]
    print(f"{results.count(PASSED)} of {len(results)} scenarios passed, "
          f"{results.count(SKIPPED)} skipped")
    if not results or set(results) - {PASSED, SKIPPED}:
        return FAILED
    return PASSED if PASSED in results else SKIPPED


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", help="folder of cremed and cremed-simulate")
    parser.add_argument("--only", default="", help="scenarios with this in their name")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--scenario", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.scenario:
        run_one(arguments)
    sys.exit(run_all(arguments))
