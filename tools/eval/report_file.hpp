// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

namespace cremed {

/// A text file, written atomically when it is closed; every failure is a std::runtime_error that
/// names it.
class ReportFile {
 public:
  explicit ReportFile(std::string path);
  ~ReportFile();
  ReportFile(const ReportFile&) = delete;
  ReportFile& operator=(const ReportFile&) = delete;

  [[nodiscard]] std::FILE* stream() const { return file_.get(); }
  /// Writes the file; throws on failure.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  char* text_ = nullptr;  // Buffer of the stream.
  std::size_t size_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace cremed
