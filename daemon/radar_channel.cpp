// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/radar_channel.hpp"

#include <cmath>

namespace cremed {
RadarChannel::RadarChannel(const RadarConfiguration& configuration, std::size_t radar_index,
                           std::uint8_t interface_index)
    : index(radar_index),
      interface(interface_index),
      decoder(configuration.decoder.make_decoder()),
      assembler(*decoder, std::llround(configuration.scan_timeout_s * 1e6),
                std::llround(configuration.stamp_offset_s * 1e6)),
      estimator(configuration.ego_motion),
      self_check(configuration.ego_motion),
      scan_clock(decoder->framing().counter_modulus) {}

void RadarChannel::correct_doppler(double factor) {
  doppler_factor_ *= factor;
  estimator.correct_doppler(factor);
  self_check.begin_anew();
}

void RadarChannel::count(const EgoMotion& motion) {
  status_.last_motion_status = motion.status;
  ++status_.motions_by_status[static_cast<std::size_t>(motion.status)];
  if (motion.has_estimate()) {
    status_.utime_last_estimate_us = motion.utime_us;
    status_.motions_of_incomplete_scans += motion.incomplete ? 1 : 0;
  }
}

void RadarChannel::count(const Odometry& odometry) {
  status_.scans_in_odometry += (odometry.radars >> index) & 1U;
}

void RadarChannel::note_report(const RadarReport& report) { status_.odometry = report; }

void RadarChannel::begin_period() {
  status_.latency = {latency_.count(), latency_.quantile_us(0.5), latency_.quantile_us(0.99),
                     latency_.max_us()};
  latency_.clear();
}

const RadarStatus& RadarChannel::status(std::int64_t utime_us, const FrameSource& source) {
  status_.utime_us = utime_us;
  status_.source = source.counters();
  status_.bus = source.bus(interface);
  status_.health = decoder->health();
  status_.decoder = decoder->counters();
  status_.assembler = assembler.counters();
  status_.selection = estimator.selection();
  status_.belief.doppler_nis = self_check.doppler().mean();
  status_.belief.next_nis = self_check.next().mean();
  status_.belief.is_speed_checked = self_check.speed().is_checked();
  const DopplerScale& scale = self_check.scale();
  status_.belief.doppler_correction =
      scale.is_wrong() ? std::optional(doppler_factor_ * scale.correction()) : std::nullopt;
  status_.belief.doubts =
      self_check.doubts() | (is_ahead ? std::uint32_t{stamps_run_ahead} : 0U) |
      (is_behind ? std::uint32_t{stamps_run_behind} : 0U) |
      (status_.odometry.is_left_out ? std::uint32_t{other_radars_contradict} : 0U);
  return status_;
}

}  // namespace cremed
