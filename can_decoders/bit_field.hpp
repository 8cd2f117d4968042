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
  bool is_signed = false;  ///< Two's complement.

  [[nodiscard]] constexpr std::int64_t least() const {
    return is_signed ? -(std::int64_t{1} << (length - 1)) : 0;
  }
  [[nodiscard]] constexpr std::int64_t greatest() const {
    return least() + (std::int64_t{1} << length) - 1;
  }
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

  [[nodiscard]] constexpr std::int64_t get(BitField field) const {
    const auto raw = static_cast<std::int64_t>((word_ >> shift(field)) & mask(field));
    return raw > field.greatest() ? raw - (std::int64_t{1} << field.length) : raw;
  }
  [[nodiscard]] constexpr bool flag(std::uint8_t bit) const { return get({bit, 1}) != 0; }

  /// Sets the signal to the low bits of `value`.
  constexpr void set(BitField field, std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value) & mask(field);
    word_ = (word_ & ~(mask(field) << shift(field))) | (bits << shift(field));
  }

  [[nodiscard]] constexpr std::uint8_t byte(std::size_t index) const {
    return static_cast<std::uint8_t>(word_ >> (big_ ? 56U - 8U * index : 8U * index));
  }

 private:
  constexpr PayloadBits(std::span<const std::uint8_t> bytes, bool big) : big_(big) {
    const std::size_t count = std::min<std::size_t>(bytes.size(), 8);
    for (std::size_t i = 0; i < count; ++i) {
      word_ |= std::uint64_t{bytes[i]} << (big ? 56 - 8 * i : 8 * i);
    }
  }

  static constexpr std::uint64_t mask(BitField field) {
    return (std::uint64_t{1} << field.length) - 1U;
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

  [[nodiscard]] constexpr double operator()(std::int64_t raw) const {
    return (static_cast<double>(raw) - zero) / steps_per_unit;
  }

  /// The nearest raw number that `field` can hold; NaN becomes that of 0.
  [[nodiscard]] std::int64_t raw(double value, BitField field) const {
    const double nearest = std::round((std::isnan(value) ? 0.0 : value) * steps_per_unit + zero);
    return static_cast<std::int64_t>(std::clamp(nearest, static_cast<double>(field.least()),
                                                static_cast<double>(field.greatest())));
  }
};

/// Reads the signals of a message. Each message has a function that names its signals once, for
/// SignalReader and SignalWriter alike:
///
///     template <typename Signal>
///     void signals(const Signal& signal, Message& m) {
///       signal({8, 4}, m.code);                     // position, member: the raw number
///       signal({16, 12}, {500.0, 10.0}, m.range_m);  // with its scale: the physical value
///     }
class SignalReader {
 public:
  explicit SignalReader(const PayloadBits& bits) : bits_(bits) {}

  template <typename Code>
  void operator()(BitField field, Code& code) const {
    code = static_cast<Code>(bits_.get(field));
  }
  template <typename Number>
  void operator()(BitField field, LinearScale scale, Number& value) const {
    value = static_cast<Number>(scale(bits_.get(field)));
  }

 private:
  const PayloadBits& bits_;
};

/// Writes the signals of a message; values beyond their field become its limits.
class SignalWriter {
 public:
  explicit SignalWriter(PayloadBits& bits) : bits_(bits) {}

  template <typename Code>
  void operator()(BitField field, const Code& code) const {
    bits_.set(field, static_cast<std::int64_t>(code));
  }
  template <typename Number>
  void operator()(BitField field, LinearScale scale, const Number& value) const {
    bits_.set(field, scale.raw(static_cast<double>(value), field));
  }

 private:
  PayloadBits& bits_;
};

}  // namespace cremed
