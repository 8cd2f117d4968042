# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is wrong with a drive, and its remedy: what stands first on its page."""
import json
import subprocess

from programs import replays

GOOD = ("ok", "standing_still")
TOLD_APART = (*GOOD, "silent")  # of_silences() names the radars.
SEVERITIES = ("error", "warning", "note")  # As the doctor's, the worst first.
NO_SCAN = ": no scan "
MOST_SPANS = 3  # That are named.
# How the odometry was, the worst first. `STARTING`: any other way.
REMEDIES = {"ambiguous": "most targets moved with the vehicle (a jam), or a mount, a type or a key that inverts a sign is wrong",
            "lost": "the scans at that time tell whether a radar saw too little, or none came",
            "predicted": "the scans at that time tell whether a radar saw too little, or none came"}
STARTING = "a drive begins with a second of driving or of standing still"
ANEW = "it began anew after it was lost or ambiguous: those seconds tell why"
CONTRADICTED = ("compare its mount, its type and the keys that invert a sign with the vehicle; "
                "`cremed-eval calibrate LOG --config FILE` finds yaw, scale and offset")
# The doctor's words on what the seconds in doubt are about.
OF_DOUBTS = ("few scans give an estimate", "the odometry", "its covariance", "its Doppler", "positions of its targets")
SAME_MOUNT = "have the same mount"
LONG_START_S = 5.0  # An odometry begins within two seconds of driving.


def finding(severity, what, remedy=""):
    return {"severity": severity, "what": what, "remedy": remedy}


def of_the_doctor(doctor, logs, config):
    """cremed-doctor's findings on a candump log."""
    command = [doctor, "--json", *replays(logs)] + (["--config", config] if config else [])
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
    try:
        return json.loads(done.stdout)["findings"]
    except ValueError:  # It says why it has none.
        return [finding("error", line.removeprefix("cremed-doctor: ")) for line in done.stderr.splitlines()]


def of_messages():
    """For a log in which the doctor finds no frames to examine."""
    return finding("note", "a log of messages tells no remedies",
                   "record the frames too, `candump -l any`, for `cremed-doctor --replay LOG`")


def spans(changes, end, is_wrong):
    """[(begin, end)] of [(time, name)] while is_wrong(name); neighbours are one."""
    found = []
    for (begin, name), (until, _) in zip(changes, [*changes[1:], (end, "")]):
        if is_wrong(name):
            if found and found[-1][1] == begin:
                begin = found.pop()[0]
            found.append((begin, until))
    return found


def told(times):
    """"from 3.1 s to 4.0 s and 2 times more, 5.2 s in all"""
    text = ", ".join(f"from {begin:.1f} s to {end:.1f} s" for begin, end in times[:MOST_SPANS])
    if len(times) > MOST_SPANS:
        text += f" and {len(times) - MOST_SPANS} times more"
    return text + (f", {sum(end - begin for begin, end in times):.1f} s in all" if len(times) > 1 else "")


def common(spans_of):
    """[(begin, end)] that all the lists share."""
    shared = spans_of[0] if spans_of else []
    for others in spans_of[1:]:
        shared = [(max(a, c), min(b, d)) for a, b in shared for c, d in others if max(a, c) < min(b, d)]
    return shared


def places(breaks):
    """"12.0 s, 15.1 s and 2 times more\""""
    more = f" and {len(breaks) - MOST_SPANS} times more" if len(breaks) > MOST_SPANS else ""
    return ", ".join(f"{one['t']:.1f} s" for one in breaks[:MOST_SPANS]) + more


def about(seconds):
    """Known but for the time between two scans."""
    return f"about {seconds:.0f} s" if seconds < 86400 else f"{seconds / 86400:.1f} days"


def of_breaks(breaks, clock_steps):
    """Where the log does not continue what comes before. `clock_steps`: as cremed counted them."""
    kinds = {kind: [one for one in breaks if one["kind"] == kind] for kind in ("clock", "pause", "restart")}
    clock, found = "record when the computer's clock is right: after NTP or GNSS has set it", []
    for one in kinds["clock"][:MOST_SPANS]:
        found.append(finding("warning", f"the clock was set {'back' if one['by_s'] < 0 else 'forward'} by "
                                        f"{about(abs(one['by_s']))} after {one['t']:.1f} s: the odometry restarts there, "
                                        "and times go on without the step", clock))
    small = max(clock_steps, len(kinds["clock"])) - len(found)
    if small:
        found.append(finding("warning", f"the clock was set {small} times{' more' if found else ''}: the odometry "
                                        "restarts each time", clock))
    if kinds["pause"]:
        found.append(finding("warning", f"nothing was recorded for {about(kinds['pause'][0]['by_s'])} after "
                                        f"{places(kinds['pause'])}, or the clock was set: that time is left out",
                             "one log a drive; " + clock))
    if kinds["restart"]:
        found.append(finding("warning", f"cremed began anew after {places(kinds['restart'])}: the path begins at 0 there, and "
                                        "length and counters are those of all runs together",
                             "`journalctl -u cremed` tells why; the candump log of the drive, replayed, is one run"))
    return found


def of_silences(silences, radars):
    """`silences`: [(begin, end)] of each source. What all radars share is told once."""
    of_radars = {radar: [tuple(span) for span in silences.get(radar, [])] for radar in radars}
    shared = common(list(of_radars.values())) if len(of_radars) > 1 else []
    found = [finding("warning", f"all radars were silent {told(shared)}",
                     "what recorded the buses paused, or their common supply did")] if shared else []
    for radar, times in of_radars.items():
        own = [(begin, end) for begin, end in times if not any(begin < b and a < end for a, b in shared)]
        if own:
            found.append(finding("warning", f"{radar}{NO_SCAN}{told(own)}",
                                 "check its supply and plug for loose contacts; it may have restarted"))
    return found


def of_the_odometry(changes, end):
    """Until it was good for the first time it was starting, whatever it said."""
    begin = next((time for time, name in changes if name in GOOD), end) if changes else 0.0
    found = []
    if begin > LONG_START_S:
        before = {name for time, name in changes if time < begin}
        name = next((name for name in REMEDIES if name in before), "")
        found.append(finding("warning", ("the odometry was never usable" if begin == end else
                                         f"the odometry began {begin:.1f} s after the drive")
                             + (f": it was {name}" if name else ""), REMEDIES.get(name, STARTING)))
    for name in sorted({name for time, name in changes if time > begin} - {*TOLD_APART}):
        times = spans([change for change in changes if change[0] >= begin], end, lambda other, name=name: other == name)
        found.append(finding("warning", f"the odometry was {name} {told(times)}", REMEDIES.get(name, ANEW)))
    return found


def of_the_radar(radar, changes, figures, end):
    """One finding of all that was in doubt, or none."""
    parts, causes = [], figures["statuses_left_out"]
    if causes:
        known = [cause.replace("_", " ") for cause in causes if cause != "unknown"]
        parts.append(f"left out of the odometry for {sum(causes.values())} s: " + (", ".join(known) or "the cause is not known"))
    for name in sorted({name for _, doubts in changes for name in doubts.split(" + ") if name}):
        times = spans(changes, end, lambda doubts, name=name: name in doubts.split(" + "))
        parts.append(f"in doubt {told(times)}: {name.replace('_', ' ')}")
    return [finding("warning", f"{radar}: {'; '.join(parts)}", CONTRADICTED)] if parts else []


def of_the_drive(data):
    """Of the numbers of a page: which seconds, which radar."""
    end = data["figures"]["duration_s"]
    found = [] if data["figures"]["odometry"] else [
        finding("error", "there is no odometry in this drive: the page shows each radar by itself",
                "the other findings tell why, or odometry.enabled is false")]
    radars = data["figures"]["radars"].values()
    found += of_breaks(data["breaks"], max((radar["counters"]["clock_steps"] for radar in radars), default=0))
    found += of_the_odometry(data["statuses"].get("odometry", []), end)
    found += of_silences(data["silences"], data["figures"]["radars"])
    for radar, changes in data["doubts"].items():
        found += of_the_radar(radar, changes, data["figures"]["radars"][radar], end)
    return found


def without_what_is_told(of_doctor, of_drive):
    """The doctor names the longest silence of a radar, the findings of the drive all of them, and no step of the clock.
    It names how long the odometry was of no use, they the seconds."""
    told_silences = any(text in one["what"] for one in of_drive for text in (NO_SCAN, "were silent", "the clock was set"))
    told_uses = any(one["what"].startswith("the odometry ") for one in of_drive)
    return [one for one in of_doctor if not (told_silences and f"{NO_SCAN}from" in one["what"])
            and not (told_uses and one["what"].startswith("the odometry was "))]


def joined(of_doctor, of_drive, radars):
    """With the seconds in doubt of a radar in the doctor's finding on it, if there is one: it has the cause and the remedy."""
    if any(SAME_MOUNT in one["what"] for one in of_doctor):  # From which all doubts follow.
        return of_doctor + [one for one in of_drive if one["remedy"] != CONTRADICTED]
    found, rest = [dict(one) for one in of_doctor], []
    for one in of_drive:
        radar, _, seconds = one["what"].partition(": ")
        cause = next((other for other in found if radar in radars and one["remedy"] == CONTRADICTED
                      and other["what"].startswith(f"{radar}: ") and any(text in other["what"] for text in OF_DOUBTS)), None)
        if cause:
            cause["what"] += f"; {seconds}"
        else:
            rest.append(one)
    return found + rest


def in_order(found):
    return sorted(found, key=lambda one: SEVERITIES.index(one["severity"]))
