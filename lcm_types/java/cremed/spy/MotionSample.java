// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import cremed.ego_motion_t;
import cremed.odometry_t;
import java.util.Set;

/** Speed and yaw rate of a message, with their sigma; NaN without an estimate. */
public record MotionSample(
    long utime,
    long seq,
    String source,
    String status,
    double speedMps,
    double speedStdMps,
    double yawRateRadps,
    double yawRateStdRadps) {
  /** Statuses that come with an estimate worth drawing: as in nav_msgs.Odometry. */
  private static final Set<String> USABLE = Set.of("ok", "standing_still", "predicted");

  private static final long LONGEST_STEP_US = 500_000;
  private static final int X = 0; // On the diagonal of a 3 by 3 covariance.
  private static final int YAW = 8;

  public static MotionSample of(odometry_t message) {
    double[] variance = message.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps;
    return new MotionSample(
            message.utime,
            message.seq,
            "odometry",
            MessageRows.status(message),
            message.vx_in_vehicle_frame_mps,
            Math.sqrt(variance[X]),
            message.yaw_rate_radps,
            Math.sqrt(variance[YAW]))
        .onlyIfUsable();
  }

  /** The means from scan to scan. */
  public static MotionSample of(ego_motion_t message) {
    double dt = 1e-6 * (message.utime - message.utime_start);
    double[] variance = message.covariance_x_y_yaw_m_rad;
    return new MotionSample(
            message.utime,
            message.seq,
            message.source,
            MessageRows.status(message),
            message.x_in_start_frame_m / dt,
            Math.sqrt(variance[X]) / dt,
            message.yaw_in_start_frame_rad / dt,
            Math.sqrt(variance[YAW]) / dt)
        .onlyIfUsable();
  }

  public boolean isUsable() {
    return Double.isFinite(speedMps);
  }

  /** No message is missing between them. */
  public boolean isNextTo(MotionSample before) {
    return seq == before.seq + 1 && utime - before.utime <= LONGEST_STEP_US;
  }

  private MotionSample onlyIfUsable() {
    boolean isFinite =
        Double.isFinite(speedMps + speedStdMps) && Double.isFinite(yawRateRadps + yawRateStdRadps);
    return USABLE.contains(status) && isFinite
        ? this
        : new MotionSample(
            utime, seq, source, status, Double.NaN, Double.NaN, Double.NaN, Double.NaN);
  }
}
