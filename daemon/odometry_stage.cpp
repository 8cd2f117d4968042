// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/odometry_stage.hpp"

#include <algorithm>
#include <cstdint>

#include "cremed/estimator/fusion/output/fused_motion.hpp"

namespace cremed {
namespace {

/// Used in place of the targets of a scan that repeats the previous one: it is no measurement.
const TargetSet kNoTargets;

std::vector<Pose2> mounts(const Configuration& configuration) {
  std::vector<Pose2> mounts;
  for (const RadarConfiguration& radar : configuration.radars) {
    mounts.push_back(radar.ego_motion.vehicle_from_radar);
  }
  return mounts;
}

/// With three degrees of freedom the vehicle may slip sideways: 14 degrees within a second.
OdometryOptions odometry_options(const Configuration& configuration) {
  constexpr double kSkidRad = 0.25;
  OdometryOptions options = configuration.odometry.filter;
  const bool may_skid = std::ranges::any_of(configuration.radars, [](const auto& radar) {
    return radar.ego_motion.registration.degrees_of_freedom == 3;
  });
  if (may_skid) {
    options.slip_std_rad = std::max(options.slip_std_rad, kSkidRad);
    options.slip_walk = std::max(options.slip_walk, kSkidRad);
  }
  return options;
}

}  // namespace

OdometryStage::OdometryStage(const Configuration& configuration,
                             const std::vector<std::optional<LearnedErrors>>& learned,
                             const Radars& radars, const BusClocks& clocks, OdometrySink& outputs,
                             PipelineClock clock)
    : radars_(radars),
      clocks_(clocks),
      outputs_(outputs),
      clock_(clock),
      queue_(configuration.radars.size()),
      is_predicted_(configuration.odometry.filter.rate_hz != 0),
      standstill_mps_(configuration.odometry.filter.standstill_mps) {
  if (configuration.odometry.enabled) {
    filter_.emplace(odometry_options(configuration), mounts(configuration), learned);
  }
}

void OdometryStage::make_room(std::size_t radar) {
  while (queue_.holds(radar)) {
    use(*queue_.pop());
  }
}

void OdometryStage::hold(const RadarChannel& radar, std::int64_t stamp_us) {
  if (filter_) {
    queue_.push({radar.index, stamp_us});
  }
}

void OdometryStage::use_ready() {
  const auto is_awaiting = [this](const ScanQueue::Scan& scan) { return this->is_awaiting(scan); };
  while (const auto scan = queue_.pop(now_us_, is_awaiting)) {
    use(*scan);
  }
}

void OdometryStage::advance_to(std::int64_t now_us) {
  for (auto deadline_us = queue_.deadline_us(); deadline_us && *deadline_us < now_us;
       deadline_us = queue_.deadline_us()) {
    now_us_ = *deadline_us + 1;
    predict_to(*deadline_us);
    use_ready();
  }
  now_us_ = now_us;
  predict_to(now_us);
}

void OdometryStage::forget() {
  queue_.clear();
  if (filter_) {
    filter_->forget();
  }
}

/// Whether a scan that began before it is still open.
bool OdometryStage::is_awaiting(const ScanQueue::Scan& scan) const {
  const std::uint8_t interface = radars_[scan.radar]->interface;
  return std::ranges::any_of(radars_, [&](const auto& other) {
    const auto open_us = other->assembler.open_stamp_us();
    return open_us && *open_us < scan.stamp_us && clocks_.agree(other->interface, interface);
  });
}

/// Not if positions contradict the speed. Other doubts by the radar's own check are decisive only
/// if the comparison with the other radars is not: a mount may be off, which the odometry learns.
bool OdometryStage::is_trusted(const RadarChannel& radar) const {
  const std::uint32_t doubts = radar.self_check.doubts();
  return (doubts & positions_contradict_speed) == 0 &&
         ((doubts & ~covariance_too_large) == 0 || !filter_->is_fault_unknown());
}

void OdometryStage::use(const ScanQueue::Scan& scan) {
  predict_to(scan.stamp_us);
  const RadarChannel& radar = *radars_[scan.radar];
  const TargetSet& targets =
      radar.self_check.is_repeated() ? kNoTargets : radar.estimator.targets();
  const std::int64_t begin_us = clock_.now_us();
  const Odometry odometry = filter_->update(radar.index, targets, scan.stamp_us, is_trusted(radar));
  const std::int64_t solve_us = clock_.now_us() - begin_us;
  if (const double factor = filter_->take_doppler_factor(); factor != 1.0) {
    for (const auto& each : radars_) {
      each->correct_doppler(factor);
    }
  }
  if (!odometry.is_new) {
    return;
  }
  odometry_ = odometry;
  for (const auto& each : radars_) {
    each->count(odometry);
  }
  if (!is_predicted_) {
    outputs_.on_odometry(odometry);
  }
  if (radars_.size() > 1) {
    outputs_.on_fused(fused_motion(odometry, targets.size(), standstill_mps_),
                      static_cast<std::int32_t>(solve_us));
  }
}

/// The filter predicts over max_gap_s at most.
void OdometryStage::predict_to(std::int64_t now_us) {
  while (const auto odometry = filter_ ? filter_->predict_next(now_us) : std::nullopt) {
    outputs_.on_odometry(*odometry);
  }
}

}  // namespace cremed
