// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/detection.hpp"

namespace cremed::fuzz {

inline void check(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// The fuzzer's bytes in order; 0 when there are no more.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

  [[nodiscard]] bool done() const { return bytes_.empty(); }

  std::uint8_t byte() {
    if (done()) {
      return 0;
    }
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }

  /// Most significant byte first.
  std::uint64_t number(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
      value = value << 8U | byte();
    }
    return value;
  }

  /// Any frame, with `id` if it is not 0: flags, length byte (possibly wrong), data.
  CanFrame frame(std::uint32_t id) {
    const std::uint8_t flags = byte();
    CanFrame frame{.id = id != 0 ? id : static_cast<std::uint32_t>(number(4)), .length = byte()};
    frame.extended = flags == 1;
    frame.remote = flags == 2;
    frame.error = flags == 3;
    frame.fd = flags == 4;
    for (std::size_t i = 0; i < 8; ++i) {
      frame.data[i] = byte();
    }
    return frame;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// The guarantees of detection.hpp.
inline void check_detection(const Detection& d) {
  for (const double value : {d.range_m, d.azimuth_rad, d.doppler_mps, d.rcs_dbm2}) {
    check(std::isfinite(value));
  }
  const bool has_noise = d.validity != Validity::no_noise && d.validity != Validity::no_position &&
                         d.validity != Validity::empty;
  for (const double std : {d.range_std_m, d.azimuth_std_rad, d.doppler_std_mps}) {
    check(std::isfinite(std));
    check(has_noise ? std > 0.0 : std == 0.0);
  }
  check(d.range_m >= 0.0 && std::abs(d.azimuth_rad) <= 3.1416);
}

}  // namespace cremed::fuzz
