# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a drive's report has where there is truth: cremed-eval measures, this picks and places."""
import bisect
import math

from programs import evaluate, read_poses
from thinning import extremes, rounded
from truth_findings import against_truth


def truth_data(programs, lcm_log, drive, heard, folder):
    figures, errors, drift, gaps = evaluate(programs, lcm_log, drive, folder)
    poses = read_poses(drive.truth)
    begin_s = (poses[0][0] - heard.begin_us) * 1e-6  # cremed-eval counts from truth's begin.
    return {"figures": figures, "truth_std": drive.truth_stds,
            "errors": {source: error_series(columns, begin_s) for source, columns in errors.items()},
            "drift": {source: {name: rounded(column) for name, column in columns.items()}
                      for source, columns in drift.items()},
            "gaps": [[round((gap[name] - heard.begin_us) * 1e-6, 3) for name in ("begin_us", "end_us")] for gap in gaps],
            "comparison": against_truth(poses, heard.odometry),
            "path": true_path(poses, heard.odometry, [gap["end_us"] for gap in gaps])}


def error_series(columns, begin_s):
    kept = extremes([columns[name] for name in ("x_m", "y_m", "yaw_deg", "nees")], 250)
    return {"t": [round(columns["time_s"][i] + begin_s, 4) for i in kept],
            **{name: rounded((column[i] for i in kept), 4) for name, column in columns.items()
               if name not in ("time_s", "speed_mps", "yaw_rate_degps", "true_yaw_rate_degps",
                               "true_speed_mps")}}


def true_path(poses, odometry, gap_ends):
    """Truth in the frame "odom": laid onto the odometry at the first time that both tell. It begins anew after
    each gap, at the places in `begins`."""
    first = next((i for i, utime in enumerate(odometry["utime"])
                  if poses[0][0] <= utime <= poses[-1][0]), None)
    if first is None:
        return {"x": [], "y": [], "begins": []}
    _, x0, y0, yaw0 = min(poses, key=lambda pose: abs(pose[0] - odometry["utime"][first]))
    turn = odometry["yaw"][first] - yaw0
    cos, sin = math.cos(turn), math.sin(turn)
    placed = [(odometry["x"][first] + cos * (x - x0) - sin * (y - y0),
               odometry["y"][first] + sin * (x - x0) + cos * (y - y0)) for utime, x, y, _ in poses
              if utime <= odometry["utime"][-1]]
    times = [utime for utime, *_ in poses[:len(placed)]]
    first_of_part = [i for i in (bisect.bisect_left(times, end) for end in gap_ends) if 0 < i < len(placed)]
    ends = {place for i in first_of_part for place in (i - 1, i)}
    kept = sorted({*extremes([[x for x, _ in placed], [y for _, y in placed]]), *ends})
    return {"x": rounded((placed[i][0] for i in kept), 6), "y": rounded((placed[i][1] for i in kept), 6),
            "begins": [kept.index(i) for i in first_of_part]}
