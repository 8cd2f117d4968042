// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/report_file.hpp"

#include <stdexcept>
#include <utility>

namespace cremed {

ReportFile::ReportFile(std::string path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "w")) {
  if (file_ == nullptr) {
    throw std::runtime_error("cannot write " + path_);
  }
}

void ReportFile::close() {
  std::FILE* const file = file_.release();
  const bool is_lost = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || is_lost) {
    throw std::runtime_error("cannot write " + path_);
  }
}

}  // namespace cremed
