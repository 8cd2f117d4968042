# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed as it runs on a vehicle, without a service manager: its log, notifications and end."""
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import threading
import time


class Failure(Exception):
    """A failed expectation."""


class Skipped(Exception):
    """This computer lacks something for a scenario."""


# Far more than anything takes on an idle computer: it ends a scenario that fails, and measures nothing.
WAIT_LIMIT_S = 45


def wait_until(condition, expected):
    """Returns the condition's first true value."""
    deadline = time.monotonic() + WAIT_LIMIT_S
    while time.monotonic() < deadline:
        if value := condition():
            return value
        time.sleep(0.02)
    raise Failure(f"not within {WAIT_LIMIT_S} s: {expected}")


def check(condition, expected):
    if not condition:
        raise Failure(expected)


def radar(name, interface, *keys, kind="ars408", x_m=3.6, yaw_rad=0.0):
    """One [[radar]] table."""
    return "\n".join(["[[radar]]", f'name = "{name}"', f'type = "{kind}"',
                      f'interface = "{interface}"', *keys, "[radar.mount]", f"x_m = {x_m}",
                      "y_m = 0.0", f"yaw_rad = {yaw_rad}", ""])


FRONT = radar("front", "vcan0")
REAR = radar("rear", "vcan1", kind="bosch_gpr", x_m=-0.9, yaw_rad=3.14159)


class LiveDaemon:
    """One cremed, with the priority and the few privileges of its unit."""

    def __init__(self, folder, program, configuration, live=('realtime = "off"',), user="nobody"):
        self.folder = pathlib.Path(folder)
        self.max_latency_s = next((float(option.split("=")[1]) for option in live
                                   if option.startswith("max_latency_s")), 0.5)
        self.configuration = self.folder / "cremed.toml"
        self.configuration.write_text("\n".join(["[live]", *live, configuration]))
        # The build may be readable by root only.
        self.program = shutil.copy(program, self.folder / "cremed")
        self.lines, self.notifications = [], []
        self.start_time_s = time.monotonic()
        self.process = subprocess.Popen(
            [self.program, "--config", self.configuration], stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, user=user, group=pwd.getpwnam(user).pw_gid, extra_groups=[],
            env={**os.environ, "NOTIFY_SOCKET": self.open_notify_socket()})
        os.sched_setscheduler(self.process.pid, os.SCHED_FIFO, os.sched_param(20))
        threading.Thread(target=self.read_log, daemon=True).start()

    def open_notify_socket(self):
        path = str(self.folder / "notify")
        receiver = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        receiver.bind(path)
        os.chmod(path, 0o666)
        threading.Thread(target=self.read_notifications, args=(receiver,), daemon=True).start()
        return path

    def read_notifications(self, receiver):
        while True:
            self.notifications += receiver.recv(4096).decode().split("\n")

    def read_log(self):
        for line in self.process.stderr:
            self.lines.append(line.rstrip())

    def log(self, *words):
        """The log's lines with all of the words, in any case."""
        return [line for line in list(self.lines)
                if all(word.lower() in line.lower() for word in words)]

    def status_text(self):
        texts = [text for text in list(self.notifications) if text.startswith("STATUS=")]
        return texts[-1][len("STATUS="):] if texts else ""

    def wait_ready(self):
        wait_until(lambda: "READY=1" in self.notifications, "READY=1")

    def wait_log(self, *words):
        return wait_until(lambda: self.log(*words), f"a log line with {words}")

    def open_files(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def signal(self, number):
        self.process.send_signal(number)

    def stop(self):
        """Ends it; returns exit status and duration."""
        begin_s = time.monotonic()
        self.signal(signal.SIGTERM)
        status = self.process.wait(WAIT_LIMIT_S)
        return status, time.monotonic() - begin_s
