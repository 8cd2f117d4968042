// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed::test {

/// Parses "701#004E81FC80200147".
inline CanFrame hex_frame(std::string_view text, std::int64_t stamp_us = 0) {
  const auto number = [text](std::size_t begin, std::size_t count) {
    return std::stoul(std::string(text.substr(begin, count)), nullptr, 16);
  };
  const std::size_t separator = text.find('#');
  CanFrame frame{.stamp_us = stamp_us, .id = static_cast<std::uint32_t>(number(0, separator))};
  for (std::size_t i = separator + 1; i + 1 < text.size(); i += 2) {
    frame.data[frame.length++] = static_cast<std::uint8_t>(number(i, 2));
  }
  return frame;
}

inline std::span<const std::uint8_t> bytes_of(const CanFrame& frame) {
  return std::span(frame.data).first(frame.length);
}

}  // namespace cremed::test
