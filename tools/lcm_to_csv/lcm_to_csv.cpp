// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lcm_to_csv/lcm_to_csv.hpp"

#include <algorithm>
#include <string_view>

#include <cremed/ego_motion_t.hpp>
#include <cremed/odometry_t.hpp>

#include "daemon/output/csv_writer.hpp"
#include "daemon/output/odometry_writer.hpp"
#include "tools/lcm_log_reader.hpp"

namespace cremed {
namespace {

constexpr std::string_view kMotionChannel = "CREMED_EGO_MOTION";
constexpr std::string_view kOdometryChannel = "CREMED_ODOMETRY";
constexpr std::size_t kLongestSource = 15;

/// A source name that would break a CSV row is refused; the daemon writes none.
bool is_source(std::string_view name) {
  return !name.empty() && name.size() <= kLongestSource &&
         std::ranges::all_of(name, [](char c) { return c > ' ' && c != ','; });
}

bool is_good(const ego_motion_t& message) {
  return is_source(message.source) && message.status >= 0 &&
         message.status < static_cast<int>(kMotionStatusCount);
}

bool is_good(const odometry_t& message) {
  return message.status >= 0 && message.status < static_cast<int>(kOdometryStatusCount);
}

Eigen::Matrix3d matrix(const double (&row_major)[9]) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&row_major[0]);
}

EgoMotion ego_motion(const ego_motion_t& message) {
  EgoMotion motion;
  motion.utime_start_us = message.utime_start;
  motion.utime_us = message.utime;
  motion.status = static_cast<MotionStatus>(message.status);
  motion.motion << message.x_in_start_frame_m, message.y_in_start_frame_m,
      message.yaw_in_start_frame_rad;
  motion.covariance = matrix(message.covariance_x_y_yaw_m_rad);
  motion.targets = message.num_targets;
  motion.iterations = message.num_iterations;
  return motion;
}

/// The row of a message.
Odometry odometry(const odometry_t& message) {
  Odometry odometry;
  odometry.utime_us = message.utime;
  odometry.utime_anchor_us = message.utime_anchor;
  odometry.status = static_cast<OdometryStatus>(message.status);
  odometry.pose << message.x_in_anchor_frame_m, message.y_in_anchor_frame_m,
      message.yaw_in_anchor_frame_rad;
  odometry.covariance = matrix(message.covariance_x_y_yaw_in_anchor_frame_m_rad);
  odometry.odom_pose << message.x_in_odom_frame_m, message.y_in_odom_frame_m,
      message.yaw_in_odom_frame_rad;
  odometry.twist << message.vx_in_vehicle_frame_mps, message.vy_in_vehicle_frame_mps,
      message.yaw_rate_radps;
  odometry.twist_covariance = matrix(message.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps);
  return odometry;
}

/// Writes the message as the row that `to_row` makes; counts it, or counts it as bad.
template <typename Message, typename ToRow>
void convert(const LoggedMessage& logged, const ToRow& to_row, LineFile& csv, std::uint64_t& count,
             std::uint64_t& bad) {
  const auto message = decoded<Message>(logged.data.data(), logged.data.size());
  if (message && is_good(*message)) {
    csv.write(to_row(*message).view());
    ++count;
  } else {
    ++bad;
  }
}

}  // namespace

LcmLogCounters lcm_to_csv(const std::string& log_path, LineFile& csv, LineFile* odometry_csv) {
  LcmLogReader log(log_path);
  csv.write(kMotionCsvHeader);
  if (odometry_csv != nullptr) {
    odometry_csv->write(kOdometryCsvHeader);
  }
  const auto motion_row = [](const ego_motion_t& m) {
    return motion_csv_row(m.source, ego_motion(m), m.solve_us);
  };
  const auto odometry_row = [](const odometry_t& m) { return odometry_csv_row(odometry(m)); };
  LcmLogCounters counters;
  while (const LoggedMessage* logged = log.next()) {
    if (logged->channel == kMotionChannel) {
      convert<ego_motion_t>(*logged, motion_row, csv, counters.motions, counters.bad_messages);
    } else if (logged->channel == kOdometryChannel && odometry_csv != nullptr) {
      convert<odometry_t>(*logged, odometry_row, *odometry_csv, counters.odometries,
                          counters.bad_messages);
    }
  }
  counters.damage = log.damage();
  return counters;
}

}  // namespace cremed
