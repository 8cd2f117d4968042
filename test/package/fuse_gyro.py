# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fuses cremed's odometry with a gyro: yaw since the start, and the gyro's bias with its sigma.

    fuse_gyro.py GYRO.csv [LOG of lcm-logger]      GYRO.csv: utime,yaw_rate_radps

Neighbouring messages share errors (the body's for 0.3 s, the mounts' permanently): used as one
measurement each, they would make the filter overconfident. Errors from anchor to anchor
(odometry.anchor_period_s) count as independent for a minute: one measurement per anchor.
"""
import bisect
import csv
import sys

import cremed

GYRO_NOISE = 0.002  # rad/sqrt(s)
START_BIAS_STD = 0.02  # rad/s


class YawFilter:
    """State: yaw and bias; a Kalman filter of the turn from anchor to anchor."""

    def __init__(self):
        self.yaw_rad, self.bias_radps, self.bias_variance = 0.0, 0.0, START_BIAS_STD**2

    def add(self, seconds, gyro_turn_rad, odometry_turn_rad, odometry_variance):
        turn_rad = gyro_turn_rad - self.bias_radps * seconds
        turn_variance = self.bias_variance * seconds**2 + GYRO_NOISE**2 * seconds
        covariance = -self.bias_variance * seconds  # of turn and bias
        innovation = (odometry_turn_rad - turn_rad) / (turn_variance + odometry_variance)
        self.yaw_rad += turn_rad + turn_variance * innovation
        self.bias_radps += covariance * innovation
        self.bias_variance -= covariance**2 / (turn_variance + odometry_variance)


class Gyro:
    """The angle turned, from samples in a file; replace it with the vehicle's gyro."""

    def __init__(self, path):
        self.utimes, self.angles_rad = [], []
        with open(path, encoding="ascii") as file:
            for row in csv.DictReader(file):
                utime, before = int(row["utime"]), self.angles_rad[-1] if self.utimes else 0.0
                seconds = (utime - self.utimes[-1]) * 1e-6 if self.utimes else 0.0
                self.utimes.append(utime)
                self.angles_rad.append(before + float(row["yaw_rate_radps"]) * seconds)
        if not self.utimes:
            raise ValueError(f"{path}: no rows of utime,yaw_rate_radps")

    def turn_rad(self, begin, end):
        at = [min(bisect.bisect(self.utimes, utime), len(self.utimes) - 1) for utime in (begin, end)]
        return self.angles_rad[at[1]] - self.angles_rad[at[0]]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    gyro, estimate, last = Gyro(sys.argv[1]), YawFilter(), None
    for heard in cremed.read_log(sys.argv[2]) if sys.argv[2:] else cremed.Listener():
        message = heard.message
        if not isinstance(message, cremed.odometry_t) or message.status > message.STATUS_STANDING_STILL:
            continue
        if last and message.utime < last.utime:
            raise ValueError("the clock was set back: nothing spans that; begin anew")
        if last and message.utime_anchor != last.utime_anchor:  # `last` is the last message of its anchor.
            begin, end = last.utime_anchor, last.utime
            estimate.add((end - begin) * 1e-6, gyro.turn_rad(begin, end), last.yaw_in_anchor_frame_rad,
                         last.covariance_x_y_yaw_in_anchor_frame_m_rad[8])
            # Messages were lost, or the radars were silent.
            missing_s = (message.utime_anchor - end) * 1e-6
            estimate.yaw_rad += gyro.turn_rad(end, message.utime_anchor) - estimate.bias_radps * missing_s
            print(f"{message.utime_anchor} yaw {estimate.yaw_rad:.5f} rad, bias "
                  f"{estimate.bias_radps:.5f} +- {estimate.bias_variance**0.5:.5f} rad/s", flush=True)
        last = message


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError) as error:  # What came before damage of a log was used.
        sys.exit(f"fuse_gyro.py: {error}")
    except KeyboardInterrupt:
        sys.exit(1)
