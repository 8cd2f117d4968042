// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include <unistd.h>

namespace cremed {

/// A file in the system's temporary folder, removed by the destructor.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view content = {}) {
    std::string name = "/tmp/cremed-test-XXXXXX";
    const int descriptor = ::mkstemp(name.data());
    if (descriptor < 0) {
      throw std::runtime_error("mkstemp failed");
    }
    ::close(descriptor);
    path_ = name;
    std::ofstream(path_) << content;
  }
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string content() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string path_;
};

}  // namespace cremed
