// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline.hpp"

#include <algorithm>
#include <utility>

#include "cremed/estimator/fusion/output/fused_motion.hpp"
#include "cremed/estimator/doubt/vehicle/motion_witness.hpp"
#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

std::vector<OdometryRadar> odometry_radars(
    const Configuration& configuration, const std::vector<std::optional<LearnedErrors>>& learned) {
  std::vector<OdometryRadar> radars;
  for (const RadarConfiguration& radar : configuration.radars) {
    const std::size_t i = radars.size();
    radars.push_back(
        {radar.ego_motion.vehicle_from_radar, i < learned.size() ? learned[i] : std::nullopt});
  }
  return radars;
}

/// Bound on the difference between synchronised hardware stamps and the order of arrival; a
/// fraction of any time-out.
constexpr std::int64_t kMaxClockDifferenceUs = 5'000;

/// Bound on the duration of a scan, for which later scans wait: the cycle of an ARS408.
constexpr std::int64_t kLongestScanUs = 75'000;

/// A bit of RadarChannel::shares_clock.
static_assert(kMaxRadars <= 32);
constexpr std::uint32_t bit_of(std::uint8_t interface) { return 1U << interface; }

bool share_clock(const RadarChannel& a, const RadarChannel& b) {
  return (a.shares_clock & bit_of(b.interface)) != 0 && (b.shares_clock & bit_of(a.interface)) != 0;
}

/// With three degrees of freedom the vehicle may slip sideways: 14 degrees within a second.
OdometryOptions odometry_options(const Configuration& configuration) {
  constexpr double kSkidRad = 0.25;
  OdometryOptions options = configuration.odometry.filter;
  const bool may_skid = std::any_of(
      configuration.radars.begin(), configuration.radars.end(),
      [](const auto& radar) { return radar.ego_motion.registration.degrees_of_freedom == 3; });
  if (may_skid) {
    options.slip_std_rad = std::max(options.slip_std_rad, kSkidRad);
    options.slip_walk = std::max(options.slip_walk, kSkidRad);
  }
  return options;
}

}  // namespace

Pipeline::Pipeline(const Configuration& configuration, const FrameSource& source,
                   std::vector<OdometrySink*> sinks, PipelineClock clock,
                   const std::vector<std::optional<LearnedErrors>>& learned)
    : source_(source),
      sinks_(std::move(sinks)),
      clock_(clock),
      vehicle_(configuration),
      is_predicted_(configuration.odometry.filter.rate_hz != 0),
      standstill_mps_(configuration.odometry.filter.standstill_mps) {
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    radars_.push_back(std::make_unique<RadarChannel>(configuration.radars[i], i,
                                                     interface_index(configuration, i)));
  }
  if (configuration.odometry.enabled) {
    filter_.emplace(odometry_options(configuration), odometry_radars(configuration, learned));
  }
}

bool Pipeline::take_next(FrameSource& source) {
  CanFrame frame;
  const SourceEvent event = source.next(frame);
  on_event(event, frame);
  return event != SourceEvent::end;
}

void Pipeline::on_event(SourceEvent event, const CanFrame& frame) {
  switch (event) {
    case SourceEvent::frame:
      on_frame(frame);
      break;
    case SourceEvent::dropped:
      on_dropped(frame.interface);
      break;
    case SourceEvent::clock_step:
      on_clock_step();
      break;
    case SourceEvent::idle:
      on_idle(frame.stamp_us);
      break;
    case SourceEvent::end:
      break;
  }
}

void Pipeline::on_frame(const CanFrame& frame) {
  const std::int64_t begin_us = clock_.is_stamp_clock ? frame.stamp_us : clock_.now_us();
  note_clock(frame);
  on_time(frame.interface, frame.stamp_us);
  expire(frame.stamp_us, frame.interface);
  if (const auto reading = vehicle_.read(frame); reading && filter_) {
    filter_->add(*reading);
  }
  for (const auto& radar : radars_) {
    if (radar->interface == frame.interface) {
      const ScanPart part = radar->decoder->decode(frame);
      if (part.kind != ScanPart::Kind::none && clocks_.is_set_back(frame)) {
        on_clock_step();
      }
      radar->assembler.add(part);
      publish_motions(*radar, begin_us);
    }
  }
  publish_held();
}

/// The clocks of two buses may differ. A frame stamped before an earlier frame of another bus shows
/// that; frames of that bus then do not advance the time of this one.
void Pipeline::note_clock(const CanFrame& frame) {
  const std::uint32_t before = bit_of(std::exchange(last_interface_, frame.interface));
  if (!time_us_ || before == bit_of(frame.interface)) {
    return;
  }
  const bool agree = *time_us_ - frame.stamp_us <= kMaxClockDifferenceUs;
  for (const auto& radar : radars_) {
    if (radar->interface == frame.interface) {
      radar->shares_clock = (radar->shares_clock & ~before) | (agree ? before : 0U);
    }
  }
}

/// Closes the overdue scans at the time of a frame of `interface`, or of silence on all buses, in
/// the order of their time-outs.
void Pipeline::expire(std::int64_t now_us, std::optional<std::uint8_t> interface) {
  const auto is_overdue = [&](const RadarChannel& radar) {
    const bool is_comparable = !interface || *interface == radar.interface ||
                               (radar.shares_clock & bit_of(*interface)) != 0;
    return is_comparable && radar.assembler.is_overdue(now_us);
  };
  while (RadarChannel* radar = first_to_close(is_overdue)) {
    const std::int64_t deadline_us = *radar->assembler.deadline_us();
    reach(deadline_us);
    event_us_ = deadline_us + 1;
    radar->assembler.expire(now_us);
    publish_motions(*radar, now_us);
  }
  reach(now_us);
}

/// Releases overdue held scans and predictions that are due, each at its own time.
void Pipeline::reach(std::int64_t now_us) {
  for (RadarChannel* held = first_held();
       held != nullptr && *held->held_us + kLongestScanUs < now_us; held = first_held()) {
    event_us_ = *held->held_us + kLongestScanUs + 1;
    publish_predictions(event_us_ - 1);
    publish_held();
  }
  event_us_ = now_us;
  publish_predictions(now_us);
}

/// The open scan with the earliest time-out among those that meet the condition.
template <typename Condition>
RadarChannel* Pipeline::first_to_close(Condition condition) {
  RadarChannel* first = nullptr;
  for (const auto& radar : radars_) {
    const auto deadline_us = radar->assembler.deadline_us();
    if (deadline_us && condition(*radar) &&
        (first == nullptr || *deadline_us < *first->assembler.deadline_us())) {
      first = radar.get();
    }
  }
  return first;
}

void Pipeline::publish_motions(RadarChannel& radar, std::int64_t begin_us) {
  while (const RadarScan* scan = radar.assembler.next()) {
    publish(radar, *scan, begin_us);
  }
}

void Pipeline::publish(RadarChannel& radar, const RadarScan& scan, std::int64_t begin_us) {
  while (radar.held_us) {
    publish_odometry(*first_held());  // update() replaces this radar's targets.
  }
  if (radar.scan_clock.is_set_forward(scan)) {
    forget_motions();
  }
  const std::int64_t solve_begin_us = clock_.now_us();
  EgoMotion motion = radar.estimator.update(scan);
  const std::int64_t solve_us = clock_.now_us() - solve_begin_us;
  radar.self_check.add(motion, radar.estimator.targets());
  motion.covariance *= radar.self_check.covariance_factor();
  if (filter_) {
    filter_->compare(radar.index, motion, radar.self_check.is_trusted());
  }
  if (odometry_ && contradicts(*odometry_, motion)) {
    motion = withdrawn(motion);
  }
  radar.count(motion);
  for (OdometrySink* sink : sinks_) {
    sink->on_motion(radar.index, motion, static_cast<std::int32_t>(solve_us));
  }
  hold(radar, motion);
  publish_held();
  radar.note_duration(clock_.now_us() - begin_us, solve_us);
  for (OdometrySink* sink : sinks_) {
    sink->on_scan(radar.index, scan);
  }
}

/// That the positions of a radar contradict its Doppler is decisive only if the comparison with the
/// others is not: a mount may be off that the odometry learns.
bool Pipeline::is_trusted(const RadarChannel& radar) const {
  return (radar.self_check.doubts() & positions_contradict_speed) == 0 &&
         (radar.self_check.is_trusted() || !filter_->is_fault_unknown());
}

/// Holds every scan with usable targets, registered or not.
void Pipeline::hold(RadarChannel& radar, const EgoMotion& motion) {
  const bool was_ahead = std::exchange(radar.is_ahead, clocks_.is_ahead(radar.interface));
  if (radar.is_ahead != was_ahead) {
    forget_odometry();
  }
  if (!filter_ || radar.estimator.targets().size() == 0 || radar.is_ahead) {
    return;
  }
  radar.held_us = motion.utime_us;
}

void Pipeline::forget_odometry() {
  for (const auto& radar : radars_) {
    radar->held_us.reset();
  }
  if (filter_) {
    filter_->forget();
  }
}

/// The earliest held scan; null if none.
RadarChannel* Pipeline::first_held() const {
  RadarChannel* first = nullptr;
  for (const auto& radar : radars_) {
    if (radar->held_us && (first == nullptr || *radar->held_us < *first->held_us)) {
      first = radar.get();
    }
  }
  return first;
}

void Pipeline::publish_held() {
  for (RadarChannel* first = first_held(); first != nullptr && !is_awaiting(*first);
       first = first_held()) {
    publish_odometry(*first);
  }
}

/// Whether a scan that began before the held one is still open.
bool Pipeline::is_awaiting(const RadarChannel& radar) const {
  return event_us_ - *radar.held_us <= kLongestScanUs &&
         std::any_of(radars_.begin(), radars_.end(), [&](const auto& other) {
           const bool is_comparable =
               other->interface == radar.interface || share_clock(*other, radar);
           const auto open_us = other->assembler.open_stamp_us();
           return is_comparable && open_us && *open_us < *radar.held_us;
         });
}

void Pipeline::publish_odometry(RadarChannel& radar) {
  const std::int64_t stamp_us = *radar.held_us;
  const TargetSet& targets = radar.estimator.targets();
  radar.held_us.reset();
  publish_predictions(stamp_us);
  const std::int64_t begin_us = clock_.now_us();
  const Odometry odometry = filter_->update(radar.index, targets, stamp_us, is_trusted(radar));
  const std::int64_t solve_us = clock_.now_us() - begin_us;
  if (!odometry.is_new) {
    return;
  }
  odometry_ = odometry;
  for (const auto& each : radars_) {
    each->count(odometry);
  }
  if (!is_predicted_) {
    for (OdometrySink* sink : sinks_) {
      sink->on_odometry(odometry);
    }
  }
  if (radars_.size() > 1) {
    publish_fused(targets.size(), solve_us);
  }
}

/// The filter predicts over max_gap_s at most.
void Pipeline::publish_predictions(std::int64_t now_us) {
  while (const auto odometry = filter_ ? filter_->predict_next(now_us) : std::nullopt) {
    for (OdometrySink* sink : sinks_) {
      sink->on_odometry(*odometry);
    }
  }
}

void Pipeline::publish_fused(std::size_t targets, std::int64_t solve_us) {
  const EgoMotion fused = fused_motion(*odometry_, targets, standstill_mps_);
  for (OdometrySink* sink : sinks_) {
    sink->on_fused(fused, static_cast<std::int32_t>(solve_us));
  }
}

void Pipeline::on_time(std::size_t clock, std::int64_t now_us) {
  time_us_ = now_us;
  if (status_timer_.is_due(clock, now_us)) {
    status_timer_.restart();
    publish_status();
  }
}

void Pipeline::publish_status() {
  for (const auto& radar : radars_) {
    radar->begin_period();
    if (filter_) {
      radar->note_report(filter_->report(radar->index));
    }
    const RadarStatus& status =
        radar->status(clock_.is_stamp_clock ? clock_.now_us() : *time_us_, source_);
    for (OdometrySink* sink : sinks_) {
      sink->on_status(radar->index, status);
    }
  }
}

void Pipeline::on_dropped(std::uint8_t interface) {
  for (const auto& radar : radars_) {
    if (radar->interface == interface) {
      radar->assembler.mark_dropped();
    }
  }
}

void Pipeline::on_clock_step() {
  for (const auto& radar : radars_) {
    radar->assembler.mark_dropped();
    radar->assembler.finish();
    publish_motions(*radar, clock_.now_us());
  }
  forget_motions();
}

/// No motion spans a step of the clock.
void Pipeline::forget_motions() {
  for (const auto& radar : radars_) {
    radar->estimator.forget_reference();
    radar->self_check.forget();
    radar->scan_clock.forget();
  }
  forget_odometry();
}

void Pipeline::on_idle(std::int64_t now_us) {
  on_time(StatusTimer::kNoInterface, now_us);
  expire(now_us);
}

std::size_t Pipeline::frames_to_next_scan() const {
  std::optional<std::size_t> least;
  for (const auto& radar : radars_) {
    if (const auto awaited = radar->assembler.awaited_parts()) {
      least = std::min(least.value_or(*awaited), *awaited);
    }
  }
  return least.value_or(0);
}

VehicleStatus Pipeline::vehicle(VehicleSignal signal) const {
  return {filter_ ? filter_->report(signal) : VehicleSignalReport(), vehicle_.bad_frames(signal)};
}

std::vector<std::optional<LearnedErrors>> Pipeline::learned() const {
  const bool is_good = odometry_ && (odometry_->status == OdometryStatus::ok ||
                                     odometry_->status == OdometryStatus::standing_still);
  return is_good ? filter_->learned() : std::vector<std::optional<LearnedErrors>>();
}

void Pipeline::finish() {
  while (RadarChannel* radar = first_to_close([](const RadarChannel&) { return true; })) {
    radar->assembler.finish();
    publish_motions(*radar, clock_.now_us());
  }
  publish_held();
  if (time_us_) {
    publish_status();
  }
}

}  // namespace cremed
