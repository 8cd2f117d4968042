// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace cremed {

/// A text file to write; every failure is a std::runtime_error that names it.
class ReportFile {
 public:
  explicit ReportFile(std::string path);

  [[nodiscard]] std::FILE* stream() const { return file_.get(); }
  /// Closes the file; throws if anything was not written.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace cremed
