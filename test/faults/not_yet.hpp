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

inline constexpr const char* kFalseAlarm =
    "2 to 3 % of the rows of scene 1094 are beyond 5 sigma by the noise of truth";
inline constexpr const char* kOrder =
    "noticed above some speed or in turns only; the noise of truth on scene 1094";
inline constexpr const char* kNoWitness = "positions tell it after a second, a lever in turns only";
inline constexpr const char* kAllDoubted =
    "noticed within a second, whose rows count; verified anew after its end";
inline constexpr const char* kTime =
    "noticed when braking or turning only; the scan of a step itself";
inline constexpr const char* kMajority =
    "a radar among targets that move together contradicts its positions or the others";

inline constexpr auto kNotYet = std::to_array<NotYet>({
    {"healthy 105 unflagged", "AI", "", "a side radar or the speed check, for seconds"},
    {"scale 0.90", "BU", "BU", kOrder},
    {"scale 0.95", "BU", "", kOrder},
    {"scale 1.05", "I", "", kOrder},
    {"scale 1.10", "U", "U", kOrder},
    {"alone, scale 0.90", "B", "", "scene 1094 starts at walking pace"},
    {"sign flipped", "B", "B", kFalseAlarm},
    {"upside down", "BU", "", kNoWitness},
    {"mount 5 deg off", "B", "", kOrder},
    {"mount 10 deg off", "B", "", kOrder},
    {"mount 2 m ahead", "U", "I", kNoWitness},
    {"buses swapped", "BIU", "B", kOrder},
    {"all flipped for 5 s", "R", "", kAllDoubted},
    {"all zero for 5 s", "R", "", kAllDoubted},
    {"all repeat from 8 s", "B", "", kAllDoubted},
    {"all repeat for 5 s", "BR", "", kAllDoubted},
    {"late 300 ms", "B", "BU", kTime},
    {"late 500 ms", "", "BU", kTime},
    {"stamps 1 s ahead", "B", "", kTime},
    {"clock step +0.1 s", "B", "", kTime},
    {"clock step +0.5 s", "B", "", kTime},
    {"clock step +1.0 s", "B", "", kFalseAlarm},
    {"clock step -0.1 s", "B", "", kTime},
    {"clock step -0.5 s", "B", "", kTime},
    {"clock step -1.0 s", "B", "", kTime},
    {"learned mounts wrong", "I", "", "a side radar is left out instead of learned anew"},
    {"learned scales wrong", "B", "", kFalseAlarm},
    {"train", "", "I", kMajority},
    {"convoy", "", "BI", kMajority},
    {"jam-starts", "", "I", kMajority},
});

}  // namespace cremed::test
