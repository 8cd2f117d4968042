// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/source/candump.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kMaxStampUs = 999'999'999'999'999'999;  // 12 digits of seconds.

/// Appends to the buffer; all parts together are shorter than kMaxCandumpLine.
class LineWriter {
 public:
  explicit LineWriter(std::array<char, kMaxCandumpLine>& line) : line_(line) {}

  void text(std::string_view text) {
    for (const char c : text) {
      line_[size_++] = c;
    }
  }
  /// Upper-case digits with leading zeros, least significant `width` digits only.
  void number(std::uint64_t value, unsigned base, std::size_t width) {
    for (std::size_t i = width; i-- > 0; value /= base) {
      line_[size_ + i] = "0123456789ABCDEF"[value % base];
    }
    size_ += width;
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::array<char, kMaxCandumpLine>& line_;
  std::size_t size_ = 0;
};

void write_stamp(LineWriter& out, std::int64_t stamp_us) {
  const auto micros =
      static_cast<std::uint64_t>(std::clamp<std::int64_t>(stamp_us, 0, kMaxStampUs));
  const std::uint64_t seconds = micros / 1'000'000;
  std::size_t width = 10;
  for (std::uint64_t limit = 10'000'000'000; seconds >= limit; limit *= 10) {
    ++width;
  }
  out.text("(");
  out.number(seconds, 10, width);
  out.text(".");
  out.number(micros % 1'000'000, 10, 6);
  out.text(") ");
}

void write_id(LineWriter& out, const CanFrame& frame) {
  if (frame.error || frame.extended) {
    out.number((frame.id & kMaxExtendedId) | (frame.error ? kCandumpErrorFlag : 0U), 16, 8);
  } else {
    out.number(frame.id & 0x7FFU, 16, 3);
  }
  out.text("#");
}

void write_content(LineWriter& out, const CanFrame& frame) {
  const std::size_t length = std::min<std::size_t>(frame.length, frame.fd ? frame.data.size() : 8);
  if (frame.remote) {
    out.text("R");
    out.number(length, 10, length > 0 ? 1 : 0);
    return;
  }
  out.text(frame.fd ? "#0" : "");  // CanFrame does not store FD flags.
  for (std::size_t i = 0; i < length; ++i) {
    out.number(frame.data[i], 16, 2);
  }
}

}  // namespace

std::size_t format_candump_line(const CanFrame& frame, std::string_view interface_name,
                                std::array<char, kMaxCandumpLine>& line) {
  LineWriter out(line);
  write_stamp(out, frame.stamp_us);
  out.text(interface_name.substr(0, kMaxInterfaceName));
  out.text(" ");
  write_id(out, frame);
  write_content(out, frame);
  out.text("\n");
  return out.size();
}

}  // namespace cremed
