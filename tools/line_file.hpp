// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "daemon/process/output_file.hpp"

namespace cremed {

/// An OutputFile that receives large blocks of lines.
class LineFile {
 public:
  /// "-" is standard output. Throws std::runtime_error.
  explicit LineFile(const std::string& path) : file_(path) {}

  /// Complete lines; false if no more can be written.
  bool write(std::string_view lines) {
    constexpr std::size_t kManyBytes = 65536;
    text_ += lines;
    if (text_.size() >= kManyBytes) {
      write_text();
    }
    return file_.failures() == 0;
  }
  /// Writes the rest. Throws std::runtime_error if anything could not be written.
  void finish() {
    write_text();
    if (file_.failures() != 0) {
      throw std::runtime_error(file_.problem());
    }
  }

 private:
  void write_text() {
    file_.write(text_);
    text_.clear();
  }

  OutputFile file_;
  std::string text_;
};

}  // namespace cremed
