// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "daemon/output/radar_status.hpp"

namespace cremed {

/// Receiver of results. `radar` is the radar's index in the configuration. Called on the hot path:
/// implementations must not allocate or log, and count what they cannot deliver.
class OdometrySink {
 public:
  virtual ~OdometrySink() = default;

  virtual void on_scan(std::size_t /*radar*/, const RadarScan& /*scan*/) {}
  virtual void on_motion(std::size_t /*radar*/, const EgoMotion& /*motion*/,
                         std::int32_t /*solve_us*/) {}
  /// The state of the vehicle after each scan later than those before, or predicted at
  /// odometry.rate_hz.
  virtual void on_odometry(const Odometry& /*odometry*/) {}
  /// The motion since the odometry before, if there are two radars or more.
  virtual void on_fused(const EgoMotion& /*motion*/, std::int32_t /*solve_us*/) {}
  virtual void on_status(std::size_t /*radar*/, const RadarStatus& /*status*/) {}

  /// Results that could not be delivered.
  [[nodiscard]] virtual std::uint64_t failures() const { return 0; }
  /// The first failure and its cause, as text; empty if there is none to report.
  [[nodiscard]] virtual std::string problem() const { return {}; }

 protected:
  OdometrySink() = default;
  OdometrySink(const OdometrySink&) = default;
  OdometrySink& operator=(const OdometrySink&) = default;
};

}  // namespace cremed
