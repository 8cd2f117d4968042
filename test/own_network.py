# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A network of a test's own, with LCM's group on its loopback."""
import os
import subprocess
import sys

COMMAND = ["unshare", "--map-root-user", "--net", "sh", "-e", "-c",
           'ip link set lo up; ip route add 239.255.76.67/32 dev lo; exec "$0" "$@"']
URL = "udpm://239.255.76.67:7667?ttl=0"


def skip(reason):
    print("SKIPPED:", reason)
    sys.exit(77)


def enter():
    """Starts this script anew there."""
    if subprocess.run([*COMMAND, "true"], capture_output=True, check=False).returncode != 0:
        skip("this computer permits no network namespace")
    if "CREMED_OWN_NETWORK" not in os.environ:
        os.environ["CREMED_OWN_NETWORK"] = "1"
        os.execvp(COMMAND[0], [*COMMAND, *sys.orig_argv])
