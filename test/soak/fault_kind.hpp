// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cremed::soak {

enum class FaultKind : std::uint8_t {
  frame_lost,
  burst_lost,
  loss_reported,
  cycles_lost,
  frame_twice,
  data_flip,
  id_flip,
  length_wrong,
  frame_late,
  interface_down,
  clock_step,
};

/// Mean interval of a fault on each bus (the clock: on all buses) and its size between `least` and
/// `most`, uniform for integers, otherwise log-uniform.
struct FaultRow {
  FaultKind kind;
  std::string_view name;
  double mean_interval_s;
  double least;
  double most;
};

inline constexpr std::array<FaultRow, 11> kFaults{{
    {FaultKind::frame_lost, "frame lost", 2.0, 1, 1},
    {FaultKind::burst_lost, "burst lost", 20.0, 2, 40},             // frames
    {FaultKind::loss_reported, "loss reported", 10.0, 1, 20},       // frames; the source tells
    {FaultKind::cycles_lost, "cycles lost", 30.0, 0.15, 1.0},       // s
    {FaultKind::frame_twice, "frame twice", 2.0, 1, 1},             //
    {FaultKind::data_flip, "data bit flip", 2.0, 1, 1},             //
    {FaultKind::id_flip, "id bit flip", 10.0, 1, 1},                // identifier, kind of frame
    {FaultKind::length_wrong, "wrong length", 10.0, 0, 8},          // bytes
    {FaultKind::frame_late, "frame late", 2.0, 1, 3},               // frames that overtake it
    {FaultKind::interface_down, "interface down", 60.0, 0.1, 5.0},  // s; the source tells
    {FaultKind::clock_step, "clock step", 20.0, 0.01, 3600.0},      // s; the source tells
}};

/// Greatest delay of every stamp, unreported.
inline constexpr double kStampJitterUs = 100.0;

constexpr const FaultRow& row_of(FaultKind kind) { return kFaults[static_cast<std::size_t>(kind)]; }

/// Bit n: fault n of the table.
using FaultSet = std::uint32_t;

}  // namespace cremed::soak
