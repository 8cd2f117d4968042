// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iterator>
#include <string>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "daemon/process/replaced_file.hpp"

namespace cremed {

/// A text file, written atomically when it is closed.
class ReportFile {
 public:
  explicit ReportFile(std::string path) : path_(std::move(path)) {}

  template <typename... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }
  /// Writes the file; throws std::runtime_error that names it on failure.
  void close() const { replace_file(path_, text_); }

 private:
  std::string path_;
  std::string text_;
};

}  // namespace cremed
