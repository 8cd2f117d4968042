// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cremed/estimator/doubt/vehicle/motion_witness.hpp"
#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

/// Of results; a replay has no clock to judge it by.
std::optional<std::int64_t> max_age_us(const Configuration& configuration, PipelineClock clock) {
  return clock.is_stamp_clock ? std::optional(std::llround(configuration.live.max_latency_s * 1e6))
                              : std::nullopt;
}

}  // namespace

Pipeline::Pipeline(const Configuration& configuration, const FrameSource& source,
                   std::vector<OdometrySink*> sinks, PipelineClock clock,
                   const std::vector<std::optional<LearnedErrors>>& learned)
    : source_(source),
      clock_(clock),
      outputs_(std::move(sinks), max_age_us(configuration, clock), clock.now_us),
      vehicle_(configuration),
      odometry_(configuration, learned, radars_, clocks_, outputs_, clock) {
  const Interfaces interfaces = interfaces_of(configuration);
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    radars_.push_back(
        std::make_unique<RadarChannel>(configuration.radars[i], i, interfaces.of_radars[i]));
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
  clocks_.note(frame);
  on_time(frame.interface, frame.stamp_us);
  close_overdue(frame.stamp_us, frame.interface);
  if (const auto reading = vehicle_.read(frame); reading && odometry_.filter() != nullptr) {
    odometry_.filter()->add(*reading);
  }
  for (const auto& radar : radars_) {
    if (radar->interface == frame.interface) {
      const ScanPart part = radar->decoder->decode(frame);
      if (part.kind != ScanPart::Kind::none && clocks_.is_set_back(frame)) {
        on_clock_step();
      }
      radar->assembler.add(part);
      use_scans(*radar, begin_us);
    }
  }
  odometry_.use_ready();
}

void Pipeline::use_scans(RadarChannel& radar, std::int64_t begin_us) {
  while (const RadarScan* scan = radar.assembler.next()) {
    use(radar, *scan, begin_us);
  }
}

void Pipeline::use(RadarChannel& radar, const RadarScan& scan, std::int64_t begin_us) {
  odometry_.make_room(radar.index);
  const ScanTiming timing = radar.scan_clock.judge(scan);
  if (timing == ScanTiming::set_forward) {
    if (const auto step = radar.scan_clock.step()) {
      count(*step);
      forget_motions();
    }
  }
  const std::int64_t solve_begin_us = clock_.now_us();
  EgoMotion motion =
      timing == ScanTiming::late ? radar.estimator.reject(scan) : radar.estimator.update(scan);
  const std::int64_t solve_us = clock_.now_us() - solve_begin_us;
  check(radar, motion);
  radar.count(motion);
  outputs_.on_motion(radar.index, motion, static_cast<std::int32_t>(solve_us));
  hold(radar, motion);
  odometry_.use_ready();
  radar.note_latency(clock_.now_us() - begin_us);
  outputs_.on_scan(radar.index, scan);
}

/// Widens the motion of a radar that looks sideways, and withdraws a motion that contradicts the
/// odometry. That is judged before it is widened: a wider motion would contradict nothing.
void Pipeline::check(RadarChannel& radar, EgoMotion& motion) {
  OdometryFilter* filter = odometry_.filter();
  if (filter != nullptr && filter->is_start_in_doubt()) {
    radar.self_check.forget();
  } else {
    radar.self_check.add(motion, radar.estimator.targets());
  }
  if (filter != nullptr && radar.self_check.contradicts_speed() &&
      filter->refutes_speed_doubt(radar.index, motion.utime_us,
                                  radar.self_check.speed_correction())) {
    radar.self_check.acquit_speed();
  }
  const bool is_contradicted = odometry() && contradicts(*odometry(), motion);
  motion.covariance *= radar.self_check.covariance_factor();
  if (filter != nullptr) {
    filter->compare(radar.index, motion, radar.self_check.is_trusted(),
                    radar.self_check.is_speed_undecided());
  }
  if (is_contradicted) {
    motion = withdrawn(motion);
  }
}

/// Passes each scan with usable targets to the odometry, registered or not, unless its bus is ahead
/// or behind.
void Pipeline::hold(RadarChannel& radar, const EgoMotion& motion) {
  const bool was_ahead = std::exchange(radar.is_ahead, clocks_.is_ahead(radar.interface));
  radar.is_behind = clocks_.is_behind(radar.interface);
  if (radar.is_ahead != was_ahead) {
    odometry_.forget();
  }
  if (radar.estimator.targets().size() != 0 && !radar.is_ahead && !radar.is_behind) {
    odometry_.hold(radar, motion.utime_us);
  }
}

/// Closes overdue scans in the order of their time-outs. The time of a bus closes no scan of a
/// radar on another bus whose clock does not agree.
void Pipeline::close_overdue(std::int64_t now_us, std::optional<std::uint8_t> interface) {
  const auto is_overdue = [&](const RadarChannel& radar) {
    return (!interface || clocks_.follows(radar.interface, *interface)) &&
           radar.assembler.is_overdue(now_us);
  };
  // By a bus that is ahead it would be predicted beyond all scans.
  const auto advance_odometry = [&](std::int64_t time_us) {
    if (!interface || !clocks_.is_ahead(*interface)) {
      odometry_.advance_to(time_us);
    }
  };
  while (RadarChannel* radar = first_to_close(is_overdue)) {
    advance_odometry(*radar->assembler.deadline_us() + 1);
    radar->assembler.expire(now_us);
    use_scans(*radar, now_us);
  }
  advance_odometry(now_us);
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

void Pipeline::on_time(std::size_t clock, std::int64_t now_us) {
  time_us_ = now_us;
  if (status_timer_.is_due(clock, now_us)) {
    status_timer_.restart(clock);
    publish_status();
  }
}

void Pipeline::publish_status() {
  // Only live are all stamps of one clock.
  if (odometry_.filter() != nullptr && clock_.is_stamp_clock) {
    odometry_.filter()->note_lost_signals(*time_us_);
  }
  for (const auto& radar : radars_) {
    radar->begin_period();
    if (const OdometryFilter* filter = odometry_.filter()) {
      radar->note_report(filter->report(radar->index));
    }
    const std::int64_t now_us = clock_.is_stamp_clock ? clock_.now_us() : *time_us_;
    outputs_.on_status(radar->index, radar->status(now_us, source_));
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
    use_scans(*radar, clock_.now_us());
  }
  forget_motions();
}

void Pipeline::count(const ForwardStep& step) {
  if (step.by_s < 0.0) {
    return;
  }
  ++forward_steps_.count;
  forward_steps_.longest_s = std::max(forward_steps_.longest_s, step.by_s);
  forward_steps_.last = step;
}

/// No motion spans a step of the clock.
void Pipeline::forget_motions() {
  for (const auto& radar : radars_) {
    radar->estimator.forget_reference();
    radar->self_check.forget();
    radar->scan_clock.forget();
  }
  odometry_.forget();
}

void Pipeline::on_idle(std::int64_t now_us) {
  on_time(StatusTimer::kNoInterface, now_us);
  close_overdue(now_us);
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
  const OdometryFilter* filter = odometry_.filter();
  return {filter != nullptr ? filter->report(signal) : VehicleSignalReport(),
          vehicle_.bad_frames(signal)};
}

std::vector<std::optional<LearnedErrors>> Pipeline::learned() const {
  const bool is_usable = odometry() && odometry()->is_usable();
  return is_usable ? odometry_.filter()->learned() : std::vector<std::optional<LearnedErrors>>();
}

void Pipeline::finish() {
  while (RadarChannel* radar = first_to_close([](const RadarChannel&) { return true; })) {
    radar->assembler.finish();
    use_scans(*radar, clock_.now_us());
  }
  odometry_.use_ready();
  if (time_us_) {
    publish_status();
  }
}

}  // namespace cremed
