// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>

#include <Eigen/Core>

namespace cremed {

/// Builds one line of text without allocation or locale. A text that does not fit is truncated.
class TextLine {
 public:
  TextLine& text(std::string_view value) {
    size_ += value.copy(end(), buffer_.size() - size_);
    return *this;
  }
  TextLine& integer(long long value) { return advance(std::to_chars(end(), limit(), value)); }
  /// Fixed notation with `decimals` digits behind the point; "nan" for NaN.
  TextLine& fixed(double value, int decimals) {
    return advance(std::to_chars(end(), limit(), value, std::chars_format::fixed, decimals));
  }
  TextLine& scientific(double value, int decimals) {
    return advance(std::to_chars(end(), limit(), value, std::chars_format::scientific, decimals));
  }
  /// Three numbers, and the upper triangle of a matrix by rows, each after a comma.
  TextLine& numbers(const Eigen::Vector3d& values) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      text(",").fixed(values(i), 9);
    }
    return *this;
  }
  TextLine& upper_triangle(const Eigen::Matrix3d& matrix) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (Eigen::Index column = row; column < 3; ++column) {
        text(",").scientific(matrix(row, column), 9);
      }
    }
    return *this;
  }
  [[nodiscard]] std::string_view view() const { return {buffer_.data(), size_}; }

 private:
  [[nodiscard]] char* end() { return buffer_.data() + size_; }
  [[nodiscard]] char* limit() { return buffer_.data() + buffer_.size(); }
  TextLine& advance(std::to_chars_result result) {
    size_ += result.ec == std::errc{} ? static_cast<std::size_t>(result.ptr - end()) : 0;
    return *this;
  }

  std::array<char, 1024> buffer_{};
  std::size_t size_ = 0;
};

}  // namespace cremed
