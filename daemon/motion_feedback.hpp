// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/source/live_source.hpp"

namespace cremed {

/// Sends ARS408 sensors the speed and yaw rate (0x300, 0x301) estimated from their own scans, if
/// configured. A scan without estimate sends nothing: after 500 ms the sensor assumes standstill.
///
/// Two senders would contradict each other at the sensor. So it listens for a second before its
/// first frame: twice the longest pause of a sender. Once it has heard another sender, it sends
/// nothing until that is silent for ten seconds. Only time in which the bus was read counts.
class MotionFeedback final : public OdometrySink {
 public:
  static constexpr std::int64_t kFirstSilenceUs = 1'000'000;
  static constexpr std::int64_t kSilenceUs = 10'000'000;

  /// `bus` must outlive it.
  MotionFeedback(const Configuration& configuration, LiveSource& bus);

  [[nodiscard]] bool is_needed() const;
  void set_interface(std::size_t radar, std::uint8_t interface) {
    sensors_[radar].interface = interface;
  }
  /// Each frame that is received, which is never our own.
  void hear(const CanFrame& frame);
  /// Another node sends this radar's sensor speed or yaw rate: ours would contradict it.
  [[nodiscard]] bool has_rival(std::size_t radar) const { return sensors_[radar].has_rival; }
  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  [[nodiscard]] std::uint64_t failures() const override { return failures_; }

 private:
  struct Sensor {
    bool wants_feedback = false;
    std::uint8_t interface = 0;
    std::uint8_t sensor_id = 0;
    bool is_upside_down = false;
    bool has_rival = false;
    std::int64_t silence_us = 0;  // Of others, as heard.
    std::int64_t heard_us = 0;    // Stamp of the last frame on the bus.
  };
  [[nodiscard]] static bool may_speak(const Sensor& sensor);
  void send(std::uint8_t interface, const CanFrame& frame);

  LiveSource& bus_;
  std::vector<Sensor> sensors_;  // By radar.
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
