// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cremed {

/// Collects all errors of one file, so that they can be corrected at once.
class Diagnostics {
 public:
  explicit Diagnostics(std::string file_name) : file_name_(std::move(file_name)) {}

  /// `problem` states the error and a correct value.
  void add(std::size_t line, std::string_view key, std::string_view problem);

  [[nodiscard]] bool empty() const { return entries_.empty(); }

  /// "file:line: key: problem", one per line, in the order of the file.
  [[nodiscard]] std::string text() const;

 private:
  struct Entry {
    std::size_t line;
    std::string message;
  };

  std::string file_name_;
  std::vector<Entry> entries_;
};

}  // namespace cremed
