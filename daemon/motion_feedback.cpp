// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/motion_feedback.hpp"

#include <algorithm>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

/// A longer pause between frames shows that the bus was not read: a scan comes every 75 ms.
constexpr std::int64_t kLongestPauseUs = 100'000;

}  // namespace

MotionFeedback::MotionFeedback(const Configuration& configuration, LiveSource& bus) : bus_(bus) {
  const Interfaces interfaces = interfaces_of(configuration);
  for (const RadarConfiguration& radar : configuration.radars) {
    Sensor sensor;
    if (const auto* options = radar.decoder.as<Ars408Options>()) {
      sensor = {options->motion_feedback, interfaces.of_radars[sensors_.size()], options->sensor_id,
                options->invert_azimuth};
    }
    sensors_.push_back(sensor);
  }
}

bool MotionFeedback::is_needed() const {
  return std::ranges::any_of(sensors_, &Sensor::wants_feedback);
}

bool MotionFeedback::may_speak(const Sensor& sensor) {
  return sensor.silence_us >= (sensor.has_rival ? kSilenceUs : kFirstSilenceUs);
}

void MotionFeedback::hear(const CanFrame& frame) {
  for (Sensor& sensor : sensors_) {
    if (!sensor.wants_feedback || sensor.interface != frame.interface) {
      continue;
    }
    const std::int64_t pause_us = frame.stamp_us - sensor.heard_us;
    sensor.heard_us = frame.stamp_us;
    sensor.silence_us += std::clamp(pause_us, std::int64_t{0}, kLongestPauseUs);
    if (frame.is_classic_data() && is_ars408_motion(frame.id, sensor.sensor_id)) {
      sensor.silence_us = 0;
      sensor.has_rival = true;
    }
    sensor.has_rival = sensor.has_rival && !may_speak(sensor);
  }
}

void MotionFeedback::on_motion(std::size_t radar, const EgoMotion& motion,
                               std::int32_t /*solve_us*/) {
  const Sensor& sensor = sensors_[radar];
  if (!sensor.wants_feedback || !motion.has_estimate() || !may_speak(sensor)) {
    return;
  }
  const double duration_s = seconds_between(motion.utime_start_us, motion.utime_us);
  const double yaw_rate_radps = motion.motion.z() / duration_s;
  send(sensor.interface, encode_ars408_speed(sensor.sensor_id, motion.motion.x() / duration_s));
  send(sensor.interface,
       encode_ars408_yaw_rate(sensor.sensor_id,
                              sensor.is_upside_down ? -yaw_rate_radps : yaw_rate_radps));
}

void MotionFeedback::send(std::uint8_t interface, const CanFrame& frame) {
  failures_ += bus_.interfaces()[interface]->send(frame) == 0 ? 0 : 1;
}

}  // namespace cremed
