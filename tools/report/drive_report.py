# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""A drive as the page draws it: what JSON can hold, times in seconds since the drive's begin."""
import bisect
import collections
import math

import availability
import cremed
from findings import GOOD
from thinning import extremes, rounded, runs

DEG_PER_RAD = 180 / math.pi
MOTION_STATUSES = cremed.names_of(cremed.ego_motion_t, "STATUS_")
ODOMETRY_STATUSES = cremed.names_of(cremed.odometry_t, "STATUS_")
DOUBTS = cremed.names_of(cremed.status_t, "DOUBT_")
# A single radar is compared with the odometry of its own earlier scans.
OF_AN_ONLY_RADAR = {cremed.status_t.DOUBT_OTHER_RADARS_CONTRADICT: "its_own_scans_contradict_each_other"}
FAULTS = cremed.names_of(cremed.status_t, "FAULT_")
CAUSES = cremed.names_of(cremed.status_t, "CAUSE_")
SILENT = "silent"  # Among the statuses over time.
# Of status_t, by time. 0: nothing to compare yet.
NIS = ("nis_doppler", "nis_next", "odometry_nis_doppler", "odometry_nis_lateral", "odometry_nis_yaw")
# A shorter one is a lost scan or two.
LONG_SILENCE_US = 500_000
COUNTERS = tuple(cremed.names_of(cremed.status_t, "COUNTER_").values())


def whole(value):
    """What is not finite, of a target without position or noise, is 0; its validity says so."""
    return round(value) if math.isfinite(value) else 0


def names_in(bits, names):
    return [name for bit, name in sorted(names.items()) if bits & bit]


class DriveReport:
    def __init__(self, drive):
        self.drive = drive
        self.doubts = DOUBTS if len(drive.statuses) > 1 else DOUBTS | OF_AN_ONLY_RADAR
        # Of the odometry's rows those that do not continue the one before.
        self.begins = {bisect.bisect_left(drive.odometry["utime"], one.utime) for one in drive.timeline.breaks}

    def data(self):
        drive = self.drive
        return {"figures": self.figures(),
                "breaks": [{"t": self.seconds([one.utime])[0], "kind": one.kind, "by_s": round(one.by_us * 1e-6, 3)}
                           for one in drive.timeline.breaks],
                "path": self.path(),
                "rates": {name: self.rate(name, factor) for name, factor in
                          (("vx", 1), ("yaw_rate", DEG_PER_RAD))},
                "statuses": self.status_runs(),
                "silences": {source: self.spans(self.silences(times))
                             for source, (times, _) in drive.motions.items()},
                "doubts": {radar: self.doubt_runs(messages)
                           for radar, messages in drive.statuses.items()},
                "radars": {radar: self.radar_series(messages)
                           for radar, messages in drive.statuses.items()},
                "scans": [self.scan(message) for message in drive.scans()]}

    def seconds(self, utimes):
        return [round((utime - self.drive.begin_us) * 1e-6, 4) for utime in utimes]

    def spans(self, utimes):
        return [tuple(self.seconds(span)) for span in utimes]

    def availability_percent(self, times, statuses, names):
        """In the time from the first to the last row of all such, as cremed-eval has them in a file."""
        begin, end = self.rows_span(times)
        usable = [names.get(status) in GOOD for status in statuses]
        percent = availability.percent(availability.without(times, usable, begin, end), begin, end)
        return None if percent is None else round(percent, 3)

    def rows_span(self, times):
        if times is self.drive.odometry["utime"]:
            return times[0], times[-1]
        columns = [column for column, _ in self.drive.motions.values()]
        return min(map(min, columns)), max(map(max, columns))

    def silences(self, times):
        """[(begin, end)] without a row, in microseconds."""
        spans = availability.without(times, [True] * len(times), self.drive.begin_us, self.drive.end_us)
        return [(begin, end) for begin, end in spans if end - begin >= LONG_SILENCE_US]

    def figures(self):
        drive, odometry = self.drive, self.drive.odometry
        x, y = odometry["x"], odometry["y"]
        path_m = sum(math.hypot(x[i] - x[i - 1], y[i] - y[i - 1]) for i in range(1, len(x)) if i not in self.begins)
        return {"begin_utime": drive.begin_us or None,
                "duration_s": round((drive.end_us - drive.begin_us) * 1e-6, 3),
                "path_length_m": round(path_m, 2),
                "maximum_speed_mps": round(max(map(abs, odometry["vx"]), default=0), 3),
                "odometry": self.odometry_figures(),
                "sources": {source: {"motions": len(times),
                                     "availability_percent":
                                         self.availability_percent(times, statuses, MOTION_STATUSES),
                                     "statuses": counted(statuses, MOTION_STATUSES)}
                            for source, (times, statuses) in drive.motions.items()},
                "radars": {radar: self.radar_figures(messages)
                           for radar, messages in drive.statuses.items()}}

    def odometry_figures(self):
        columns = self.drive.odometry
        if not columns["utime"]:
            return None
        last = {name: column[-1] for name, column in columns.items()}
        return {"messages": len(columns["utime"]),
                "availability_percent":
                    self.availability_percent(columns["utime"], columns["status"], ODOMETRY_STATUSES),
                "statuses": counted(map(int, columns["status"]), ODOMETRY_STATUSES),
                "end": {"x_m": round(last["x"], 3), "y_m": round(last["y"], 3),
                        "yaw_deg": round(last["yaw"] * DEG_PER_RAD, 3),
                        "sigma_x_m": round(last["cov_xx"] ** 0.5, 3),
                        "sigma_y_m": round(last["cov_yy"] ** 0.5, 3)}}

    def radar_figures(self, messages):
        last = messages[-1]
        doubts = collections.Counter(name for message in messages
                                     for name in names_in(message.doubts, self.doubts))
        ends = {message.run: message for message in messages}.values()  # Each run of cremed counts from 0.
        return {"counters": {name: sum(getattr(end, name) for end in ends) for name in COUNTERS},
                "statuses_with_doubt": dict(doubts), "statuses": len(messages),
                "statuses_in_doubt": sum(message.doubts != 0 for message in messages),
                "faults": names_in(last.radar_faults, FAULTS),
                "statuses_left_out": counted((m.odometry_fault for m in messages if m.odometry_leaves_out),
                                             CAUSES),
                "latency_max_us": max(message.latency_max_us for message in messages),
                "mount_yaw_error_deg": rounded([last.odometry_mount_yaw_error_rad * DEG_PER_RAD])[0],
                "mount_yaw_error_sigma_deg":
                    rounded([last.odometry_mount_yaw_error_std_rad * DEG_PER_RAD])[0],
                "doppler_scale_error": rounded([last.odometry_doppler_scale_error])[0],
                "doppler_scale_error_sigma": rounded([last.odometry_doppler_scale_error_std])[0],
                **{name: rounded([getattr(last, name)])[0] for name in NIS}}

    def path(self):
        columns = self.drive.odometry
        kept = extremes([columns["x"], columns["y"]])
        return {"t": self.seconds(columns["utime"][i] for i in kept),
                "begins": sorted({bisect.bisect_left(kept, i) for i in self.begins}),  # Of lines.
                **{name: rounded((columns[name][i] for i in kept), 6)
                   for name in ("x", "y", "yaw", "cov_xx", "cov_xy", "cov_yy", "vx", "vy", "yaw_rate")}}

    def rate(self, name, factor):
        columns = self.drive.odometry
        value, sigma = columns[name], columns[f"sigma_{name}"]
        kept = extremes([value, sigma])
        return {"t": self.seconds(columns["utime"][i] for i in kept),
                "value": rounded(value[i] * factor for i in kept),
                "sigma": rounded((sigma[i] * factor for i in kept), 3)}

    def status_runs(self):
        odometry = self.drive.odometry
        result = {}
        if odometry["utime"]:
            result["odometry"] = self.changes(odometry["utime"], odometry["status"], ODOMETRY_STATUSES)
        for source, (times, statuses) in self.drive.motions.items():
            result[source] = self.changes(times, statuses, MOTION_STATUSES)
        return result

    def changes(self, times, statuses, names):
        """[(time, name)] where the status changes, or nothing comes any more, or something again."""
        changes = [(time, names.get(int(status), "unknown")) for time, status in runs(self.seconds(times), statuses)]
        for begin, end in self.spans(self.silences(times)):
            after = [name for time, name in changes if time <= end][-1:]
            changes = [*(change for change in changes if change[0] < begin), (begin, SILENT),
                       *((end, name) for name in after if end < self.seconds([self.drive.end_us])[0]),
                       *(change for change in changes if change[0] > end)]
        return changes

    def doubt_runs(self, messages):
        changes = runs(self.seconds(m.utime for m in messages), [m.doubts for m in messages])
        return [(time, " + ".join(names_in(bits, self.doubts))) for time, bits in changes]

    def radar_series(self, messages):
        columns = {name: [getattr(m, name) or math.nan for m in messages] for name in NIS}
        for name, field, factor in (("mount_yaw_deg", "odometry_mount_yaw_error", DEG_PER_RAD),
                                    ("doppler_scale_percent", "odometry_doppler_scale_error", 100)):
            unit = "_rad" if factor == DEG_PER_RAD else ""
            sigmas = [getattr(m, f"{field}_std{unit}") * factor for m in messages]
            columns[name] = [getattr(m, f"{field}{unit}") * factor if sigma else math.nan
                             for m, sigma in zip(messages, sigmas)]
            columns[f"{name}_sigma"] = sigmas
        kept = extremes(list(columns.values()), 300)
        return {"t": self.seconds(messages[i].utime for i in kept),
                **{name: rounded((column[i] for i in kept), 4) for name, column in columns.items()}}

    def scan(self, m):
        """Of each target: range in cm, azimuth in 0.1 mrad, Doppler and its sigma in cm/s, validity."""
        targets = []
        for i in range(m.num_detections):
            targets += [whole(100 * m.range_m[i]), whole(1e4 * m.azimuth_rad[i]),
                        whole(100 * m.doppler_mps[i]), whole(100 * m.doppler_std_mps[i]), m.validity[i]]
        return {"t": self.seconds([m.utime])[0], "source": m.source,
                "mount": rounded([m.mount_x_in_vehicle_frame_m, m.mount_y_in_vehicle_frame_m,
                                  m.mount_yaw_in_vehicle_frame_rad]),
                "twist": self.twist_at(m.utime), "targets": targets}

    def twist_at(self, utime):
        """[vx, vy, yaw rate] of the odometry at that time or the next it tells; None if never."""
        columns = self.drive.odometry
        i = min(bisect.bisect_left(columns["utime"], utime), len(columns["utime"]) - 1)
        return rounded(columns[name][i] for name in ("vx", "vy", "yaw_rate")) if i >= 0 else None


def counted(statuses, names):
    return {names.get(status, "unknown"): count
            for status, count in sorted(collections.Counter(statuses).items())}
