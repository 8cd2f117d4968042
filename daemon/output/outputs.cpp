// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/outputs.hpp"

#include <utility>

namespace cremed {

Outputs::Outputs(std::vector<OdometrySink*> sinks, std::optional<std::int64_t> max_age_us,
                 std::int64_t (*now_us)())
    : sinks_(std::move(sinks)), max_age_us_(max_age_us), now_us_(now_us) {}

template <typename Send>
void Outputs::pass(std::int64_t utime_us, const Send& send) {
  for (OdometrySink* sink : sinks_) {
    if (!max_age_us_ || now_us_() - utime_us <= *max_age_us_) {
      send(*sink);
    } else {
      ++stale_;
    }
  }
}

void Outputs::on_scan(std::size_t radar, const RadarScan& scan) {
  pass(scan.stamp_us, [&](OdometrySink& sink) { sink.on_scan(radar, scan); });
}

void Outputs::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) {
  pass(motion.utime_us, [&](OdometrySink& sink) { sink.on_motion(radar, motion, solve_us); });
}

void Outputs::on_odometry(const Odometry& odometry) {
  pass(odometry.utime_us, [&](OdometrySink& sink) { sink.on_odometry(odometry); });
}

void Outputs::on_fused(const EgoMotion& motion, std::int32_t solve_us) {
  pass(motion.utime_us, [&](OdometrySink& sink) { sink.on_fused(motion, solve_us); });
}

void Outputs::on_status(std::size_t radar, const RadarStatus& status) {
  for (OdometrySink* sink : sinks_) {
    sink->on_status(radar, status);
  }
}

}  // namespace cremed
