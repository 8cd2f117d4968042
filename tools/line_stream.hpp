// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <streambuf>
#include <string>

#include "daemon/process/output_file.hpp"

namespace cremed {

/// A stream into an OutputFile, which receives blocks of complete lines.
class LineStream {
 public:
  /// "-" is standard output. Throws std::runtime_error.
  explicit LineStream(const std::string& path) : buffer_(path), stream_(&buffer_) {}

  [[nodiscard]] std::ostream& stream() { return stream_; }
  /// Writes the rest, even without a line end. Throws std::runtime_error if anything could not be
  /// written.
  void finish();

 private:
  class Buffer : public std::streambuf {
   public:
    explicit Buffer(const std::string& path) : file_(path) {}
    void finish();

   protected:
    int_type overflow(int_type character) override;
    std::streamsize xsputn(const char* text, std::streamsize size) override;

   private:
    bool write_lines();

    OutputFile file_;
    std::string text_;
  };

  Buffer buffer_;
  std::ostream stream_;
};

}  // namespace cremed
