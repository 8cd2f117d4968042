// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <cremed/ego_motion_t.hpp>
#include <cremed/odometry_t.hpp>
#include <cremed/radar_scan_t.hpp>
#include <cremed/status_t.hpp>
#include <nlohmann/json_fwd.hpp>

#include "tools/view/thinned_path.hpp"

namespace cremed {

/// What has been heard of a vehicle, in bounded memory: its path, a minute of its motion, and the
/// last of each radar. For a thread that hears and threads that ask. Where the daemon begins anew,
/// so does this.
class HeardState {
 public:
  void take(const odometry_t& message);
  void take(const ego_motion_t& message);
  void take(const status_t& message);
  void take(const radar_scan_t& message);
  /// The log has ended: nothing more comes, and nothing grows old.
  void end();

  /// One JSON object, as view.js and cremed-top read it. What is not known is null.
  [[nodiscard]] nlohmann::json snapshot() const;
  /// The same as text.
  [[nodiscard]] std::string json() const;

 private:
  using Time = std::chrono::steady_clock::time_point;
  using HeardAt = std::optional<Time>;
  struct Radar {
    std::string name;
    std::optional<ego_motion_t> motion;
    HeardAt motion_heard;
    std::deque<std::int64_t> scans_us;  // Stamps of the last seconds.
    std::optional<status_t> status;
    std::optional<radar_scan_t> scan;
    std::optional<odometry_t> odometry_at_scan;
  };
  Radar* radar(const std::string& name);
  void note_message();
  void begin_anew();
  void keep_motion(const odometry_t& message);
  [[nodiscard]] static nlohmann::json radar_json(const Radar& radar, Time now);
  [[nodiscard]] nlohmann::json motions_json() const;
  [[nodiscard]] nlohmann::json scans_json() const;

  mutable std::mutex mutex_;
  std::int64_t messages_ = 0;
  HeardAt heard_;
  HeardAt ended_;
  std::optional<odometry_t> odometry_;
  HeardAt odometry_heard_;
  double behind_s_ = 0.0;  // This computer's clock after the stamp of the odometry.
  ThinnedPath path_;
  std::deque<odometry_t> motions_;
  std::vector<Radar> radars_;  // In the order in which they were heard: that of the configuration.
};

}  // namespace cremed
