// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cremed/ego_motion_t.hpp>
#include <cremed/odometry_t.hpp>
#include <cremed/radar_scan_t.hpp>
#include <cremed/status_t.hpp>
#include <lcm/lcm.h>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/lcm_log_file.hpp"
#include "daemon/output/nav_msgs_odometry.hpp"
#include "daemon/output/odometry_sink.hpp"

namespace cremed {

/// Publishes ego_motion_t, odometry_t, status_t and, if configured, radar_scan_t and
/// nav_msgs.Odometry over LCM. Messages of several sources go to one common channel, so that a
/// reader needs no names, and to one channel per source, because lcm-spy shows only the last
/// message of a channel. Messages are encoded into a member buffer: no allocation.
class LcmPublisher final : public OdometrySink {
 public:
  /// Does not connect: until connect() succeeds, every message counts as a failure.
  LcmPublisher(std::string url, const Configuration& configuration);

  /// Sets LCM up and publishes a first status_t of each radar: subscribers see the radars before
  /// the first frame, LCM makes its first allocations, and faults show now. Returns the problem and
  /// its remedy; empty if it succeeded. May be called again.
  std::string connect();
  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] bool is_connected() const { return lcm_ != nullptr || file_; }

  void on_scan(std::size_t radar, const RadarScan& scan) override;
  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  void on_odometry(const Odometry& odometry) override;
  void on_fused(const EgoMotion& motion, std::int32_t solve_us) override;
  void on_status(std::size_t radar, const RadarStatus& status) override;
  /// Writes what a file still lacks.
  void flush();
  [[nodiscard]] std::uint64_t failures() const override {
    return failures_ + (file_ ? file_->lost() : 0U);
  }
  [[nodiscard]] std::string problem() const override {
    return file_ ? file_->problem() : std::string();
  }

  /// For subscribers in the same process (memq://, tests).
  [[nodiscard]] lcm_t* handle() { return lcm_.get(); }

 private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  /// One radar's messages; strings and arrays are allocated once.
  struct Messages {
    ego_motion_t motion;
    radar_scan_t scan;
    status_t status;
    std::string motion_channel;
    std::string scan_channel;
    std::string status_channel;
  };
  void publish_motion(const EgoMotion& motion, std::int32_t solve_us, const std::string& channel,
                      ego_motion_t& message);
  std::string open();
  bool send(const char* channel, int size);
  /// Publishes the same bytes on each channel.
  template <typename Message>
  void publish(std::initializer_list<const char*> channels, const Message& message);

  std::string url_;
  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::optional<LcmLogFile> file_;  // Replaces lcm_ if the URL is a file to write.
  bool publish_scans_;
  std::string nav_msgs_channel_;  // Empty: not configured.
  std::vector<Messages> messages_;
  ego_motion_t fused_;
  std::string fused_channel_;
  odometry_t odometry_;
  NavMsgsOdometry nav_msgs_;
  std::array<std::uint8_t, 16384> buffer_{};
  std::uint64_t failures_ = 0;
};

/// Channel of one source: `channel`, '_' and the source's name in upper case.
std::string channel_of(const std::string& channel, const std::string& source);

}  // namespace cremed
