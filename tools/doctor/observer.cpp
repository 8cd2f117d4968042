// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/observer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/source/candump.hpp"

namespace cremed {
namespace {

/// Lines of a log may be out of order by this much.
constexpr std::int64_t kOutOfOrderUs = 1'000'000;

double seconds(std::int64_t us) { return static_cast<double>(us) * 1e-6; }

}  // namespace

Observer::Observer(const Configuration& configuration)
    : configured_buses_(interface_names(configuration).size()),
      sink_(observation_),
      pipeline_(configuration, source_, {&sink_, &observation_.odometry}, PipelineClock{}) {
  observation_.radars.resize(configuration.radars.size());
  for (const std::string& name : interface_names(configuration)) {
    bus(name);
  }
}

std::size_t Observer::index_of(std::string_view interface) const {
  const auto& buses = observation_.buses;
  const auto found = std::ranges::find(buses, interface, &BusObservation::interface);
  return static_cast<std::size_t>(found - buses.begin());
}

bool Observer::is_full() const { return observation_.buses.size() >= kMaxBuses; }

BusObservation& Observer::bus(std::string_view interface) {
  const std::size_t index = index_of(interface);
  if (index == observation_.buses.size()) {
    observation_.buses.emplace_back().interface = interface;
  }
  return observation_.buses[index];
}

void Observer::add(std::string_view interface, CanFrame frame) {
  const std::size_t index = index_of(interface);
  if (index == observation_.buses.size() && is_full()) {
    ++observation_.frames_left_out;
    return;
  }
  bus(interface).add(frame);
  advance(bus_clocks_[index], frame.stamp_us);
  note_silence();
  if (index < configured_buses_) {
    frame.interface = static_cast<std::uint8_t>(index);
    source_.count_frame();
    pipeline_.on_frame(frame);
    note_steps();
  }
}

void Observer::add_lost(std::string_view interface, std::uint64_t frames) {
  if (interface == kAllInterfaces) {
    observation_.frames_lost_of_any += frames;
    source_.count_lost(frames);
    for (std::size_t i = 0; i < configured_buses_; ++i) {
      pipeline_.on_dropped(static_cast<std::uint8_t>(i));
    }
    return;
  }
  const std::size_t index = index_of(interface);
  if (index == observation_.buses.size() && is_full()) {
    observation_.frames_left_out += frames;
    return;
  }
  bus(interface).status.frames_lost += frames;
  source_.count_lost(frames);
  if (index < configured_buses_) {
    pipeline_.on_dropped(static_cast<std::uint8_t>(index));
  }
}

void Observer::advance(Clock& clock, std::int64_t now_us) {
  const std::int64_t step_us = now_us - clock.last_us.value_or(now_us);
  if (step_us < 0 && step_us > -kOutOfOrderUs) {
    return;
  }
  const bool is_passed = clock.last_us && step_us >= 0 && seconds(step_us) < kLongestPauseS;
  clock.passed_s = is_passed ? clock.passed_s + seconds(step_us) : observation_.seconds;
  clock.last_us = now_us;
  observation_.seconds = std::max(observation_.seconds, clock.passed_s);
}

void Observer::note_silence() {
  const double length_s = observation_.seconds - last_frame_s_;
  if (length_s > kShortestPauseS) {
    observation_.silences.push_back({last_frame_s_, length_s});
  }
  last_frame_s_ = observation_.seconds;
}

void Observer::note_steps() {
  const ForwardSteps& steps = pipeline_.forward_steps();
  if (std::exchange(observation_.forward_steps, steps.count) == steps.count) {
    return;
  }
  observation_.longest_step_s = steps.longest_s;
  if (steps.last.by_s < kLongestPauseS) {  // A longer one was not counted as traffic.
    leave_out(steps.last);
  }
}

/// Sets all times after the step back by it.
void Observer::leave_out(const ForwardStep& step) {
  const Pause left_out{observation_.seconds - step.by_s - step.counted_s, step.by_s};
  const auto step_us = std::llround(step.by_s * 1e6);
  const auto correct = [&](Clock& clock) {
    if (clock.passed_s >= left_out.end_s()) {
      clock.passed_s -= step.by_s;
    } else if (clock.last_us) {
      *clock.last_us += step_us;
    }
  };
  std::ranges::for_each(bus_clocks_, correct);
  correct(clock_);
  for (RadarObservation& radar : observation_.radars) {
    radar.times.leave_out(left_out);
  }
  auto& silences = observation_.silences;
  if (!silences.empty() && silences.back().overlaps(left_out)) {
    silences.pop_back();
  }
  last_frame_s_ -= step.by_s;
  observation_.seconds -= step.by_s;
}

Observation Observer::finish() {
  std::vector<ScanTimes> times;  // Taken before finish() closes the open scans.
  times.reserve(observation_.radars.size());
  for (const RadarObservation& radar : observation_.radars) {
    times.push_back(radar.times);
    times.back().note(observation_.seconds);
  }
  pipeline_.finish();
  for (std::size_t i = 0; i < observation_.radars.size(); ++i) {
    observation_.radars[i].status = pipeline_.radars()[i]->status(0, source_);
    observation_.radars[i].times = times[i];
  }
  for (std::size_t i = 0; i < observation_.vehicle.size(); ++i) {
    observation_.vehicle[i] = pipeline_.vehicle(static_cast<VehicleSignal>(i));
  }
  return std::move(observation_);
}

void Observer::Sink::on_scan(std::size_t radar, const RadarScan& scan) {
  RadarObservation& observed = observation_.radars[radar];
  observed.times.note(observation_.seconds);
  if (scan.status != ScanStatus::complete) {
    IncompleteScans& incomplete = observed.incomplete;
    incomplete.announced_targets += scan.announced;
    incomplete.whole_targets += scan.count;
    incomplete.most_announced = std::max(incomplete.most_announced, scan.announced);
  }
}

}  // namespace cremed
