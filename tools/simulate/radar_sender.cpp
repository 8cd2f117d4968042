// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/radar_sender.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/driving_share.hpp"

namespace cremed {
namespace {

/// Random streams of each radar, separate from those of the scene and other radars.
constexpr std::uint64_t kFirstStream = 16;
constexpr std::uint64_t kOffsetStream = 256;

/// Least measured range: the azimuth must stay defined.
constexpr double kLeastMeasuredM = 0.3;

/// Cycles from power-on to the start: the counters do not begin at 0.
constexpr std::size_t kGreatestFirstCycle = 65536;

}  // namespace

RadarSender::RadarSender(const RadarCharacter& character, const ScanCycle& cycle,
                         const CanFrame& first_frame, const Scene& scene, const SenderSetup& setup)
    : cycle_(cycle),
      first_frame_(first_frame),
      scene_(scene),
      setup_(setup),
      random_(setup.seed, kFirstStream + 2 * setup.radar),
      model_(character, setup.vehicle_from_radar, scene,
             Random(setup.seed, kFirstStream + 2 * setup.radar + 1)),
      slow_offset_(setup.doppler.offset_std_mps, Random(setup.seed, kOffsetStream + setup.radar)) {
  cycle_count_ = static_cast<std::uint32_t>(random_.index(kGreatestFirstCycle));
  const double phase = random_.uniform();
  next_scan_us_ = scene.start_us() + std::llround(phase * static_cast<double>(cycle_.least_us));
  if (silent(next_scan_us_)) schedule_next();
}

FrameRequest RadarSender::request() const {
  if (sent_ < list_.size()) return {scan_stamp_us_, list_[sent_].id, list_[sent_].length};
  // The first frame must be complete, so the measurement done, before the end.
  if (next_scan_us_ + 10 * frame_time_us(8) > scene_.end_us()) return {};
  return {next_scan_us_, first_frame_.id, first_frame_.length};
}

CanFrame RadarSender::send(std::int64_t stamp_us) {
  if (sent_ == list_.size()) start_scan(stamp_us);
  CanFrame& frame = list_[sent_++];
  finish(frame, stamp_us - scan_stamp_us_);
  return frame;
}

void RadarSender::finish(CanFrame& /*frame*/, std::int64_t /*age_us*/) {}

void RadarSender::start_scan(std::int64_t stamp_us) {
  scan_stamp_us_ = stamp_us;
  const FaultOptions& faults = setup_.faults;
  const bool blind = at_end_of(faults.blind_period_s, faults.blind_s, stamp_us);
  measure(blind ? std::vector<Echo>() : model_.observe(stamp_us));
  list_.clear();
  sent_ = 0;
  encode(targets_, cycle_count_, list_);
  report_truth();
  schedule_next();
}

void RadarSender::measure(const std::vector<Echo>& echoes) {
  const double time_s = scene_.seconds(scan_stamp_us_);
  told_ = setup_.is_told_motion ? scene_.told_motion(time_s) : ToldMotion{};
  doppler_offset_mps_ =
      setup_.doppler.offset_mps +
      driving_share(scene_.course().at(time_s).speed_mps) * slow_offset_.at(time_s);
  targets_.clear();
  for (const Echo& echo : echoes) {
    const PolarStd std = noise(echo.view);
    const DetectionCorrection& factors = setup_.correction;
    Measurement target{echo, echo.view.range_m, echo.view.azimuth_rad, echo.view.doppler_mps};
    target.range_m = std::max(kLeastMeasuredM, target.range_m + factors.range_std_factor *
                                                                    std.range_m * random_.normal());
    target.azimuth_rad = measured_azimuth_rad(
        target.azimuth_rad + factors.azimuth_std_factor * std.azimuth_rad * random_.normal());
    target.doppler_mps = with_shared_errors(target.doppler_mps) +
                         factors.doppler_std_factor * std.doppler_mps * random_.normal();
    if (can_report(target)) targets_.push_back(target);
  }
  std::ranges::stable_sort(targets_, {}, &Measurement::range_m);
  targets_.resize(std::min(targets_.size(), setup_.max_targets));
}

void RadarSender::schedule_next() {
  do {
    const auto span_us = static_cast<double>(cycle_.greatest_us - cycle_.least_us);
    next_scan_us_ += cycle_.least_us + std::llround(span_us * random_.uniform());
    ++cycle_count_;
  } while (silent(next_scan_us_) && next_scan_us_ < scene_.end_us());
}

bool RadarSender::silent(std::int64_t stamp_us) const {
  return at_end_of(setup_.faults.silence_period_s, setup_.faults.silence_s, stamp_us);
}

/// Faults are at the end of each period, so that a drive begins without.
bool RadarSender::at_end_of(double period_s, double part_s, std::int64_t stamp_us) const {
  return period_s > 0.0 && std::fmod(scene_.seconds(stamp_us), period_s) >= period_s - part_s;
}

void RadarSender::report_truth() const {
  if (!setup_.observer) return;
  ScanTruth truth{setup_.radar, scan_stamp_us_, {}};
  for (const Measurement& target : targets_) truth.echoes.push_back(target.echo);
  setup_.observer(truth);
}

}  // namespace cremed
