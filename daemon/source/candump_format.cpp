// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>

#include <spdlog/fmt/fmt.h>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/source/candump.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kMaxStampUs = 999'999'999'999'999'999;  // 12 digits of seconds.

std::string id_text(const CanFrame& frame) {
  return frame.error || frame.extended
             ? fmt::format("{:08X}",
                           (frame.id & kMaxExtendedId) | (frame.error ? kCandumpErrorFlag : 0U))
             : fmt::format("{:03X}", frame.id & 0x7FFU);
}

std::string content_text(const CanFrame& frame) {
  const std::size_t length = std::min<std::size_t>(frame.length, frame.fd ? frame.data.size() : 8);
  if (frame.remote) {
    return length > 0 ? fmt::format("R{}", length) : "R";
  }
  std::string text = frame.fd ? "#0" : "";  // CanFrame does not store FD flags.
  for (std::size_t i = 0; i < length; ++i) {
    fmt::format_to(std::back_inserter(text), "{:02X}", frame.data[i]);
  }
  return text;
}

}  // namespace

std::string candump_line(const CanFrame& frame, std::string_view interface_name) {
  const std::int64_t micros = std::clamp<std::int64_t>(frame.stamp_us, 0, kMaxStampUs);
  return fmt::format("({:010}.{:06}) {} {}#{}\n", micros / 1'000'000, micros % 1'000'000,
                     interface_name.substr(0, kMaxInterfaceName), id_text(frame),
                     content_text(frame));
}

}  // namespace cremed
