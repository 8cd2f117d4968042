// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "can_decoders/can_frame.hpp"

namespace cremed {

/// What one line of a candump log is.
enum class CandumpStatus : std::uint8_t {
  frame,      ///< `frame` and `interface_name` are set.
  skipped,    ///< Comment, empty line, or a line candump writes that is no frame.
  dropped,    ///< DROPCOUNT line: `dropped_frames` were lost on `interface_name`.
  malformed,  ///< Starts like a frame but is none; `error` says what would be right.
};

struct CandumpLine {
  CandumpStatus status = CandumpStatus::skipped;
  CanFrame frame;                    ///< `interface` is left 0: the caller knows the names.
  std::string_view interface_name;   ///< Points into the parsed line.
  std::uint64_t dropped_frames = 0;
  std::string_view error;            ///< Static text.
};

/// Parses one line (without or with its line end) of `candump -l` / `-L` text:
/// `(seconds.fraction) interface id#data`, 6 or 9 decimals, optional trailing R or T. Never
/// allocates or throws.
CandumpLine parse_candump_line(std::string_view line);

/// Longest line format_candump_line writes: stamp, 15-character interface, FD frame, line end.
inline constexpr std::size_t kMaxCandumpLine = 192;

/// Writes the frame as one line with 6 decimals and a line end, as candump -L would. Returns the
/// number of characters.
std::size_t format_candump_line(const CanFrame& frame, std::string_view interface_name,
                                std::array<char, kMaxCandumpLine>& line);

}  // namespace cremed
