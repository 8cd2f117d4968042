// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>

namespace cremed {

/// Builds one line of text without allocation or locale. What does not fit is cut off.
class TextLine {
 public:
  TextLine& text(std::string_view value) {
    const std::size_t count = value.copy(end_, static_cast<std::size_t>(limit() - end_));
    end_ += count;
    return *this;
  }
  TextLine& integer(long long value) { return advance(std::to_chars(end_, limit(), value)); }
  /// Fixed notation with `decimals` digits behind the point; "nan" for NaN.
  TextLine& fixed(double value, int decimals) {
    return advance(std::to_chars(end_, limit(), value, std::chars_format::fixed, decimals));
  }
  TextLine& scientific(double value, int decimals) {
    return advance(std::to_chars(end_, limit(), value, std::chars_format::scientific, decimals));
  }
  [[nodiscard]] std::string_view view() const {
    return {buffer_.data(), static_cast<std::size_t>(end_ - buffer_.data())};
  }

 private:
  [[nodiscard]] char* limit() { return buffer_.data() + buffer_.size(); }
  TextLine& advance(std::to_chars_result result) {
    end_ = result.ec == std::errc{} ? result.ptr : end_;
    return *this;
  }

  std::array<char, 1024> buffer_{};
  char* end_ = buffer_.data();
};

}  // namespace cremed
