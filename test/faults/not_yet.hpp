// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

namespace cremed::test {

/// A kind of systematic fault with which not every demand holds: the letters of
/// FaultVerdict::failures(), and A for too few estimates of a front radar.
struct NotYet {
  std::string_view kind;
  std::string_view recorded;   ///< On recorded drives,
  std::string_view simulated;  ///< and on simulated ones.
  std::string_view reason;
};

inline constexpr const char* kOrder =
    "two that agree are believed below 1 m/s; those that look sideways err by turns";
inline constexpr const char* kNoWitness = "a lever, or left for right, in turns only";
inline constexpr const char* kAllDoubted =
    "verified anew after its end, by positions of half a second";
inline constexpr const char* kTime = "noticed when braking or turning only";

inline constexpr auto kNotYet = std::to_array<NotYet>({
    {"scale 0.90", "", "B", "0.4 s until it is named, of 20 s"},
    {"upside down", "U", "", kNoWitness},
    {"mount 2 m ahead", "U", "", kNoWitness},
    {"buses swapped", "BIU", "", kOrder},
    {"buses rotated", "B", "", kOrder},
    {"all zero for 5 s", "R", "", kAllDoubted},
    {"late 500 ms", "", "U", kTime},
    {"learned mounts wrong", "I", "", "a side radar is left out instead of learned anew"},
});

}  // namespace cremed::test
