// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace cremed {

/// Position of a signal: its least significant bit (byte * 8 + bit, bit 0 is the lowest of its
/// byte) and its length, 1..32 bits, numbered as in the vendors' tables.
struct BitField {
  std::uint8_t start;
  std::uint8_t length;
};

/// A payload of up to eight bytes as one word, from which signals are extracted. Missing bytes read
/// as zero, so nothing is read past the payload.
class PayloadBits {
 public:
  /// Motorola order: a signal grows towards lower byte numbers.
  static constexpr PayloadBits big_endian(std::span<const std::uint8_t> bytes) {
    return PayloadBits(bytes, true);
  }
  /// Intel order: a signal grows towards higher byte numbers.
  static constexpr PayloadBits little_endian(std::span<const std::uint8_t> bytes) {
    return PayloadBits(bytes, false);
  }

  [[nodiscard]] constexpr std::uint32_t get(BitField field) const {
    const std::uint64_t mask = (std::uint64_t{1} << field.length) - 1U;
    return static_cast<std::uint32_t>((word_ >> shift(field)) & mask);
  }
  [[nodiscard]] constexpr std::uint8_t get8(BitField field) const {
    return static_cast<std::uint8_t>(get(field));
  }
  [[nodiscard]] constexpr std::uint16_t get16(BitField field) const {
    return static_cast<std::uint16_t>(get(field));
  }
  [[nodiscard]] constexpr bool flag(std::uint8_t bit) const { return get({bit, 1}) != 0; }

  /// Sets the signal to the low bits of `value`.
  constexpr void set(BitField field, std::uint32_t value) {
    const std::uint64_t mask = (std::uint64_t{1} << field.length) - 1U;
    word_ = (word_ & ~(mask << shift(field))) | ((value & mask) << shift(field));
  }

  [[nodiscard]] constexpr std::uint8_t byte(std::size_t index) const {
    return static_cast<std::uint8_t>(word_ >> (big_ ? 56U - 8U * index : 8U * index));
  }

  /// The same bits as two's complement.
  [[nodiscard]] constexpr std::int32_t get_signed(BitField field) const {
    const std::int64_t sign = std::int64_t{1} << (field.length - 1);
    return static_cast<std::int32_t>((static_cast<std::int64_t>(get(field)) ^ sign) - sign);
  }

 private:
  constexpr PayloadBits(std::span<const std::uint8_t> bytes, bool big) : big_(big) {
    const std::size_t count = std::min<std::size_t>(bytes.size(), 8);
    for (std::size_t i = 0; i < count; ++i) {
      word_ |= std::uint64_t{bytes[i]} << (big ? 56 - 8 * i : 8 * i);
    }
  }

  [[nodiscard]] constexpr unsigned shift(BitField field) const {
    const unsigned byte = field.start / 8U;
    return big_ ? 56U - 8U * byte + field.start % 8U : field.start;
  }

  std::uint64_t word_ = 0;
  bool big_;
};

/// Physical value of a raw number. Division by the steps per unit is exact where possible: 12 / 5
/// is 2.4, 12 * 0.2 is not.
struct LinearScale {
  double zero;            ///< Raw number of the value 0; may be fractional.
  double steps_per_unit;  ///< 1 / factor.

  [[nodiscard]] constexpr double operator()(double raw) const {
    return (raw - zero) / steps_per_unit;
  }

  /// The nearest raw number that `field` can hold; NaN becomes that of 0.
  [[nodiscard]] std::uint32_t raw(double value, BitField field) const {
    const double greatest = static_cast<double>((std::uint64_t{1} << field.length) - 1U);
    const double nearest = std::round((std::isnan(value) ? 0.0 : value) * steps_per_unit + zero);
    return static_cast<std::uint32_t>(std::clamp(nearest, 0.0, greatest));
  }
};

}  // namespace cremed
