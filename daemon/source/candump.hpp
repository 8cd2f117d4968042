// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

inline constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;
/// Marks the identifier of an error frame.
inline constexpr std::uint32_t kCandumpErrorFlag = 0x20000000;

/// Kind of a line of a candump log.
enum class CandumpStatus : std::uint8_t {
  frame,      ///< `frame` and `interface_name` are set.
  skipped,    ///< Comment (#), empty line, or a line of candump without a frame.
  dropped,    ///< DROPCOUNT line: `dropped_frames` were lost on `interface_name`.
  malformed,  ///< Anything else; `error` states the correct form.
};

/// Of which `candump any` loses frames: one socket has those of all.
inline constexpr std::string_view kAllInterfaces = "any";

struct CandumpLine {
  CandumpStatus status = CandumpStatus::skipped;
  CanFrame frame{};                   ///< `interface` stays 0: the caller maps names.
  std::string_view interface_name{};  ///< Points into the parsed line.
  std::uint64_t dropped_frames = 0;
  std::string_view error{};  ///< Static text.
};

/// Parses one line (with or without its line end) of `candump -l` / `-L` text:
///
///     (1436509052.249713) can0 123#11223344           standard data frame, 6 or 9 decimals
///     (1436509052.249713) can0 12345678#11.22 R       extended; '.' between bytes; R or T from -x
///     (1436509052.249713) can0 123#R4                 remote request for 4 bytes
///     (1436509052.249713) can0 20000004#0020000000000000   error report: bit 29 of the identifier
///     (1436509052.249713) can0 123#1122334455667788_C raw length code 12, which also means 8 bytes
///     (1436509052.249713) can0 123##1112233           CAN FD with flags 1
///      (1436509052.249713)  can0  123   [4]  11 22 33 44    on a terminal, by -ta
///     DROPCOUNT: dropped 4722 CAN frames on 'can0' socket (total drops 4722)
///
/// 9 decimals are rounded down to microseconds. Never allocates or throws.
CandumpLine parse_candump_line(std::string_view line);

/// The frame as one line with 6 decimals and a line end, as candump -L writes it.
/// parse_candump_line restores any valid frame with a stamp of 0 to 10^18 - 1 us; other values are
/// cut to fit the format.
std::string candump_line(const CanFrame& frame, std::string_view interface_name);

}  // namespace cremed
