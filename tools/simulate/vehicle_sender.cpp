// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/vehicle_sender.hpp"

#include "cremed/can_decoders/ars408_commands.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kPeriodUs = 20'000;
constexpr std::uint8_t kLength = 2;

}  // namespace

VehicleSender::VehicleSender(const VehicleBus& bus, const VehicleErrors& errors,
                             const VehicleConfiguration& ids, std::int64_t start_us,
                             std::int64_t end_us)
    : bus_(bus),
      errors_(errors),
      ids_(ids.ids),
      start_us_(start_us),
      end_us_(end_us),
      next_us_(start_us + kPeriodUs) {
  turn_ = ids_[0] ? 0 : 1;
}

FrameRequest VehicleSender::request() const {
  return next_us_ > end_us_ || !ids_[turn_] ? FrameRequest{}
                                            : FrameRequest{next_us_, *ids_[turn_], kLength};
}

CanFrame VehicleSender::send(std::int64_t /*stamp_us*/) {
  CanFrame result = frame(static_cast<VehicleSignal>(turn_));
  result.id = *ids_[turn_];
  if (turn_ == 0 && ids_[1]) {
    turn_ = 1;
  } else {
    turn_ = ids_[0] ? 0 : 1;
    next_us_ += kPeriodUs;
  }
  return result;
}

/// With the values at the time of the request: they wait for the bus.
CanFrame VehicleSender::frame(VehicleSignal signal) const {
  const ToldMotion motion = bus_.at(static_cast<double>(next_us_ - start_us_) * 1e-6);
  return signal == VehicleSignal::speed
             ? encode_ars408_speed(0, errors_.speed_scale * motion.speed_mps)
             : encode_ars408_yaw_rate(
                   0, errors_.yaw_rate_scale * motion.yaw_rate_radps + errors_.yaw_rate_bias_radps);
}

}  // namespace cremed
