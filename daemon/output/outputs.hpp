// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/output/odometry_sink.hpp"

namespace cremed {

/// Passes results on to all sinks, live only while they are fresh: a process that was stopped or
/// starved must not send an old motion as the present one. Judged when each sink is called, by the
/// time of the measurement. A status, which tells counters of now, always passes.
class Outputs final : public OdometrySink {
 public:
  /// Without `max_age_us` nothing is too old. `now_us`: the clock of the stamps. The sinks must
  /// outlive it.
  Outputs(std::vector<OdometrySink*> sinks, std::optional<std::int64_t> max_age_us,
          std::int64_t (*now_us)());

  void on_scan(std::size_t radar, const RadarScan& scan) override;
  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  void on_odometry(const Odometry& odometry) override;
  void on_fused(const EgoMotion& motion, std::int32_t solve_us) override;
  void on_status(std::size_t radar, const RadarStatus& status) override;
  /// Results that were too old for a sink.
  [[nodiscard]] std::uint64_t failures() const override { return stale_; }

 private:
  template <typename Send>
  void pass(std::int64_t utime_us, const Send& send);

  std::vector<OdometrySink*> sinks_;
  std::optional<std::int64_t> max_age_us_;
  std::int64_t (*now_us_)();
  std::uint64_t stale_ = 0;
};

}  // namespace cremed
