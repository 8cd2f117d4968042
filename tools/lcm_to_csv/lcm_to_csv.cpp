// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lcm_to_csv/lcm_to_csv.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string_view>

#include <cremed/ego_motion_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/csv_writer.hpp"
#include "daemon/message_text.hpp"

namespace cremed {
namespace {

constexpr std::string_view kChannel = "CREMED_EGO_MOTION";
constexpr std::size_t kLongestSource = 15;

/// The daemon's names have no comma and fit a row; others must not break one.
bool is_source(std::string_view name) {
  return !name.empty() && name.size() <= kLongestSource &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c != ','; });
}

std::optional<ego_motion_t> decode(const lcm::LogEvent& event) {
  ego_motion_t message;
  try {
    if (message.decode(event.data, 0, event.datalen) != event.datalen) {
      return std::nullopt;
    }
  } catch (const std::length_error&) {  // The generated code takes a string length of 0 for -1.
    return std::nullopt;
  }
  const bool is_good = is_source(message.source) && message.status >= 0 &&
                       message.status < static_cast<int>(kMotionStatusCount);
  return is_good ? std::optional(message) : std::nullopt;
}

EgoMotion ego_motion(const ego_motion_t& message) {
  EgoMotion motion;
  motion.utime_start_us = message.utime_start;
  motion.utime_us = message.utime;
  motion.status = static_cast<MotionStatus>(message.status);
  motion.motion << message.x_in_start_frame_m, message.y_in_start_frame_m,
      message.yaw_in_start_frame_rad;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      motion.covariance(row, column) = message.covariance_x_y_yaw_m_rad[3 * row + column];
    }
  }
  motion.targets = message.num_targets;
  motion.iterations = message.num_iterations;
  return motion;
}

}  // namespace

LcmLogCounters lcm_to_csv(const std::string& log_path, std::ostream& csv) {
  lcm::LogFile log(log_path, "r");
  if (!log.good()) {
    throw std::runtime_error(concat({"cannot read ", log_path}));
  }
  csv << kOdometryCsvHeader;
  LcmLogCounters counters;
  std::int64_t read_bytes = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    read_bytes = std::ftell(log.getFilePtr());
    if (event->channel != kChannel) {
      continue;
    }
    if (const std::optional<ego_motion_t> message = decode(*event)) {
      csv << odometry_csv_row(message->source, ego_motion(*message), message->solve_us).view();
      ++counters.motions;
    } else {
      ++counters.bad_messages;
    }
  }
  counters.ends_inside_message =
      static_cast<std::uintmax_t>(read_bytes) != std::filesystem::file_size(log_path);
  return counters;
}

}  // namespace cremed
