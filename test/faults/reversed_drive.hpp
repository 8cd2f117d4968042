// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "test/faults/cluster_faults.hpp"
#include "test/faults/fault_drive.hpp"

namespace cremed::test {

/// A recorded drive of ARS408s played backwards and mirrored fore and aft: another forward drive,
/// with real targets, noise and traffic, on which no setting was chosen. In it starts are stops,
/// radars that look ahead look back, and the tyres slip to the inside of bends.
class ReversedDrive {
 public:
  static FaultDrive of(const FaultDrive& drive) { return ReversedDrive(drive).result(); }

 private:
  explicit ReversedDrive(const FaultDrive& drive)
      : drive_(drive), sum_us_(drive.frames.front().stamp_us + drive.frames.back().stamp_us) {}

  [[nodiscard]] FaultDrive result() const {
    FaultDrive result{drive_.name + " reversed", drive_.radars, frames(), truth(),
                      drive_.truth_noise};
    for (RadarConfiguration& radar : result.radars) {
      radar.ego_motion.vehicle_from_radar = mirrored(radar.ego_motion.vehicle_from_radar, -1.0);
      radar.ego_motion.correction.rotation_lead_s *= -1.0;
    }
    if (drive_.wheels) {
      std::istringstream text(wheels());
      result.wheels.emplace(text, drive_.wheels->std());
    }
    return result;
  }

  /// The list of a scan keeps its order. It may overlap the next one, which was the one before: its
  /// frames follow each other faster.
  [[nodiscard]] Frames frames() const {
    constexpr double kFaster = 0.4;
    const auto always = FaultTime{0, std::numeric_limits<std::int64_t>::max()};
    std::array<std::int64_t, 256> begin_us{};
    Arrivals arrivals;
    for (CanFrame frame : with_changed_clusters(drive_.frames, always, every_radar, mirror)) {
      const bool is_header = is_message(frame, Ars408Message::cluster_status);
      if (is_header) {
        begin_us[frame.interface] = frame.stamp_us;
        // The counter runs forward.
        frame.data[2] = static_cast<std::uint8_t>(~frame.data[2]);
        frame.data[3] = static_cast<std::uint8_t>(~frame.data[3]);
      }
      const bool is_of_list = is_header || is_message(frame, Ars408Message::cluster_general) ||
                              is_message(frame, Ars408Message::cluster_quality);
      const std::int64_t list_us = is_of_list ? begin_us[frame.interface] : frame.stamp_us;
      if (list_us == 0) continue;  // A list without beginning.
      const auto since_us = static_cast<double>(frame.stamp_us - list_us);
      frame.stamp_us = sum_us_ - list_us + static_cast<std::int64_t>(kFaster * since_us);
      arrivals.add(frame.stamp_us, frame);
    }
    return arrivals.in_order();
  }

  static void mirror(Ars408General& cluster) {
    cluster.y_m = -cluster.y_m;
    cluster.vx_mps = -cluster.vx_mps;
  }

  /// In a frame whose axis x (`sign` -1) or y (1) is reversed; forward is where it was back.
  static Pose2 mirrored(const Pose2& pose, double sign) {
    return {sign * pose.x_m, -sign * pose.y_m, std::numbers::pi - pose.yaw_rad};
  }

  [[nodiscard]] TrueTrajectory truth() const {
    std::vector<std::int64_t> utime_us = drive_.truth.utime_us();
    std::vector<Pose2> poses = drive_.truth.poses();
    std::reverse(utime_us.begin(), utime_us.end());
    std::reverse(poses.begin(), poses.end());
    for (std::int64_t& time_us : utime_us) time_us = sum_us_ - time_us;
    for (Pose2& pose : poses) pose = mirrored(pose, 1.0);
    return {utime_us, poses};
  }

  [[nodiscard]] std::string wheels() const {
    constexpr std::int64_t kStepUs = 10'000;
    std::ostringstream text;
    text << "utime,speed_mps,yaw_rate_radps\n";
    for (std::int64_t time_us = drive_.frames.back().stamp_us; time_us >= drive_.start_us();
         time_us -= kStepUs) {
      if (const auto rates = drive_.wheels->rates(time_us)) {
        text << sum_us_ - time_us << ',' << rates->x() << ',' << rates->y() << '\n';
      }
    }
    return text.str();
  }

  const FaultDrive& drive_;
  std::int64_t sum_us_;
};

}  // namespace cremed::test
