// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/freshness_gate.hpp"

#include <utility>

namespace cremed {

FreshnessGate::FreshnessGate(std::vector<OdometrySink*> receivers, std::int64_t max_age_us,
                             std::int64_t (*now_us)())
    : receivers_(std::move(receivers)), max_age_us_(max_age_us), now_us_(now_us) {}

template <typename Send>
void FreshnessGate::pass(std::int64_t utime_us, const Send& send) {
  for (OdometrySink* receiver : receivers_) {
    if (now_us_() - utime_us <= max_age_us_) {
      send(*receiver);
    } else {
      ++stale_;
    }
  }
}

void FreshnessGate::on_scan(std::size_t radar, const RadarScan& scan) {
  pass(scan.stamp_us, [&](OdometrySink& receiver) { receiver.on_scan(radar, scan); });
}

void FreshnessGate::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) {
  pass(motion.utime_us,
       [&](OdometrySink& receiver) { receiver.on_motion(radar, motion, solve_us); });
}

void FreshnessGate::on_odometry(const Odometry& odometry) {
  pass(odometry.utime_us, [&](OdometrySink& receiver) { receiver.on_odometry(odometry); });
}

void FreshnessGate::on_fused(const EgoMotion& motion, std::int32_t solve_us) {
  pass(motion.utime_us, [&](OdometrySink& receiver) { receiver.on_fused(motion, solve_us); });
}

void FreshnessGate::on_status(std::size_t radar, const RadarStatus& status) {
  for (OdometrySink* receiver : receivers_) {
    receiver->on_status(radar, status);
  }
}

}  // namespace cremed
