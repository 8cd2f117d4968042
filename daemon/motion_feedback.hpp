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
class MotionFeedback final : public OdometrySink {
 public:
  /// `bus` must outlive it.
  MotionFeedback(const Configuration& configuration, LiveSource& bus);

  [[nodiscard]] bool is_needed() const;
  void set_interface(std::size_t radar, std::uint8_t interface) {
    sensors_[radar].interface = interface;
  }
  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  [[nodiscard]] std::uint64_t failures() const override { return failures_; }

 private:
  struct Sensor {
    bool wants_feedback = false;
    std::uint8_t interface = 0;
    std::uint8_t sensor_id = 0;
  };
  void send(std::uint8_t interface, const CanFrame& frame);

  LiveSource& bus_;
  std::vector<Sensor> sensors_;  // By radar.
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
