// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/source/candump.hpp"
#include "daemon/source/line_reader.hpp"
#include "daemon/source/stamp_order.hpp"

namespace cremed {

/// The lines of one candump log, or of standard input ("-"), and what is wrong with them.
class CandumpReader {
 public:
  /// Throws std::runtime_error if the log cannot be opened or has another format.
  explicit CandumpReader(const std::string& path);

  /// False at the end, or where reading failed. A signal, or a pause of a pipe, is a skipped line.
  /// Throws std::runtime_error at the first line of a pipe with another format.
  bool next(CandumpLine& line);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const LineReader& lines() const { return lines_; }
  [[nodiscard]] std::uint64_t malformed_lines() const { return malformed_lines_; }
  /// That the log ends within its last line, which is no fault: it is still recorded, or power
  /// failed. The line is skipped. Empty: it does not.
  [[nodiscard]] std::string cut_off() const;
  /// The first malformed line, why it is, and how many there are; empty: none.
  [[nodiscard]] std::string malformed() const;
  /// Why nothing in the log can be used, with a remedy: it could not be read to its end, or its
  /// stamps are no times. Empty: it can be.
  [[nodiscard]] std::string problem() const;
  /// The message for a log without a frame.
  [[nodiscard]] std::string no_frame() const;

 private:
  std::string path_;
  LineReader lines_;
  StampOrder stamps_;
  std::uint64_t malformed_lines_ = 0;
  std::uint64_t first_malformed_ = 0;
  std::string_view reason_;
  bool is_cut_off_ = false;
  int read_error_ = 0;
};

}  // namespace cremed
