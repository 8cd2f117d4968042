// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/report_file.hpp"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "daemon/process/replaced_file.hpp"

namespace cremed {

ReportFile::ReportFile(std::string path)
    : path_(std::move(path)), file_(::open_memstream(&text_, &size_)) {
  if (file_ == nullptr) {
    throw std::runtime_error("no memory for " + path_);
  }
}

ReportFile::~ReportFile() {
  file_.reset();
  std::free(text_);
}

void ReportFile::close() {
  const bool is_lost = std::ferror(file_.get()) != 0;
  if (std::fclose(file_.release()) != 0 || is_lost) {
    throw std::runtime_error("no memory for " + path_);
  }
  replace_file(path_, {text_, size_});
}

}  // namespace cremed
