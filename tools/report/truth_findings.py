# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether the odometry is what truth says, and if not what it looks like."""
import bisect
import math

from findings import finding, told

STEP_US, LONGEST_US = 1_000_000, 3_000_000
LATEST_US = 200_000  # Of the odometry after truth: later it lacks that time.
# Of the odometry against truth, in all and after 10 s: at most 2.5 on five recorded drives (by five radars, and by
# the front one alone) and 21 simulated ones (the 22nd is a skid, which one radar with two degrees of freedom misses);
# 5.5 to 300 000 where the only radar was upside down or turned by pi.
MOST_ANEES = 10
# On those drives the odometry goes at least 0.70 as far as truth and turns at least 0.66 as much; backwards it goes
# -1.00 to -0.89 as far, mirrored it turns -1.01 to -0.65 as much.
OPPOSITE = -0.5
# Less is noise: on the straightest recorded drive truth turns by 0.008 rad in a second.
LEAST_M, LEAST_RAD = 0.5, 0.005
# Where scans are whole it goes within 2.2 % as far, with a likeness of 0.989 or more; a wrong mount turns it too.
MOST_SCALE, MOST_TURN, ALIKE = 0.05, 0.35, 0.97


def steps(poses):
    """Neighbours that are 1 to 3 s apart."""
    first = None
    for pose in poses:
        if first is None or pose[0] - first[0] >= STEP_US:
            if first and pose[0] - first[0] <= LONGEST_US:
                yield first, pose
            first = pose


def step_between(first, last):
    """(forward, to the left, turn) in the frame of the first pose."""
    dx, dy, cos, sin = last[1] - first[1], last[2] - first[2], math.cos(first[3]), math.sin(first[3])
    return cos * dx + sin * dy, cos * dy - sin * dx, math.remainder(last[3] - first[3], math.tau)


class Comparison:
    """Of two series: how much of the one is in the other, and whether nothing else is."""

    def __init__(self, pairs):
        pairs = list(pairs)
        self.ours, self.true = (sum(pair[i] ** 2 for pair in pairs) for i in (0, 1))
        self.both = sum(ours * true for ours, true in pairs)
        self.mean_true = math.sqrt(self.true / len(pairs)) if pairs else 0.0

    def ratio(self, least):
        """How many times the true one ours is; None where that is too small to tell."""
        return round(self.both / self.true, 4) if self.mean_true >= least else None

    def likeness(self):
        return self.both / math.sqrt(self.ours * self.true) if self.ours and self.true else 0.0


def against_truth(poses, odometry):
    """How many times as far, and as much turned, as truth the odometry went."""
    times, ways, turns = odometry["utime"], [], []
    for first, last in steps(poses) if times else ():
        places = [min(bisect.bisect_left(times, pose[0]), len(times) - 1) for pose in (first, last)]
        if times[0] <= first[0] and all(0 <= times[i] - pose[0] <= LATEST_US for i, pose in zip(places, (first, last))):
            ours = step_between(*((times[i], odometry["x"][i], odometry["y"][i], odometry["yaw"][i]) for i in places))
            true = step_between(first, last)
            ways += zip(ours[:2], true[:2])
            turns.append((ours[2], true[2]))
    way, turn = Comparison(ways), Comparison(turns)
    return {"way": way.ratio(LEAST_M), "turn": turn.ratio(LEAST_RAD), "likeness": round(way.likeness(), 4)}


def look(of_truth, radars):
    """(what it looks like, the remedy)"""
    way, turn = of_truth["way"], of_truth["turn"]
    whose = f"of {radars[0]}" if len(radars) == 1 else "of the radars"
    if way is not None and way < OPPOSITE:
        return ("it drives backwards",
                f"turn mount.yaw_rad {whose} by pi, or correct the sign of Doppler, or turn truth's yaw by pi")
    if turn is not None and turn < OPPOSITE:
        return ("it is mirrored: it turns right where truth turns left",
                f"change invert_azimuth {whose}, or the sign of truth's y and yaw (counter-clockwise is positive)")
    turns_alike = turn is None or abs(turn - 1) < MOST_TURN
    if way is not None and abs(way - 1) > MOST_SCALE and turns_alike and of_truth["likeness"] > ALIKE:
        return f"it goes {100 * abs(way - 1):.0f} % too {'far' if way > 1 else 'short'}", (
            f"check the unit of truth, and calibration.doppler_scale {whose}")
    return "", ("check mount, type and the keys that invert a sign; and of truth its clock and its frame (the middle of the "
                "rear axle)")


def anees_of(truth):
    """The largest of the odometry: from scan to scan, and after 10 s."""
    ours = next((one for one in truth["figures"] if one["source"] == "odometry"), None)
    late = [one["anees"] for one in ours["segments"] if one["after"] == "10 s" and one["segments"]] if ours else []
    return max((anees for anees in [ours and ours["anees"], *late] if anees), default=0.0)


def of_truth(truth, radars):
    """An error where the drive is not the one that truth tells, and what truth lacks."""
    gaps = [finding("note", f"truth is missing {told(truth['gaps'])}",
                    "errors are those of the rest of the drive")] if truth["gaps"] else []
    seen, anees = look(truth["comparison"], radars), anees_of(truth)
    ratios = (truth["comparison"][name] for name in ("way", "turn"))
    is_opposite = any(ratio is not None and ratio < OPPOSITE for ratio in ratios)
    if anees <= MOST_ANEES and not is_opposite:
        return gaps
    how = f": {seen[0]}" if seen[0] else ""
    # Truth of GNSS may be no better than the odometry.
    may_be_truth = not seen[0] and not truth["truth_std"]
    remedy = f"give --truth-std, how far truth may be off; if truth is accurate, {seen[1]}" if may_be_truth else seen[1]
    return [finding("warning" if may_be_truth else "error",
                    f"the odometry contradicts truth{how} (ANEES {anees:.1f}, 1 expected)", remedy), *gaps]
