// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/ars408_encoder.hpp"

#include <algorithm>
#include <array>

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {
namespace {

using namespace ars408_signals;

template <typename Content>
CanFrame encoded(std::uint8_t sensor_id, std::uint8_t length, Content content) {
  PayloadBits bits = PayloadBits::big_endian({});
  signals(SignalWriter(bits), content);
  return frame(static_cast<std::uint32_t>(Content::kMessage), sensor_id, length, bits);
}

}  // namespace

std::uint8_t ars408_rms_code(double standard_deviation) {
  static const std::array<double, 30> kRms = [] {  // Of the last code, any larger one.
    std::array<double, 30> rms{};
    for (std::uint8_t code = 0; code < rms.size(); ++code) rms[code] = *ars408_rms(code);
    return rms;
  }();
  return static_cast<std::uint8_t>(std::ranges::lower_bound(kRms, standard_deviation) -
                                   kRms.begin());
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterStatus& status) {
  return encoded(sensor_id, 5, status);
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectStatus& status) {
  return encoded(sensor_id, 4, status);
}

CanFrame encode_ars408_cluster(std::uint8_t sensor_id, const Ars408General& cluster) {
  return encoded(sensor_id, 8, Ars408Cluster{cluster});
}

CanFrame encode_ars408_object(std::uint8_t sensor_id, const Ars408General& object) {
  return encoded(sensor_id, 8, Ars408Object{object});
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterQuality& quality) {
  return encoded(sensor_id, 5, quality);
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectQuality& quality) {
  return encoded(sensor_id, 7, quality);
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408RadarState& state) {
  return encoded(sensor_id, 8, state);
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408Version& version) {
  return encoded(sensor_id, 4, version);
}

}  // namespace cremed
