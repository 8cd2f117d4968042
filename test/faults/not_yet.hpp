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

inline constexpr const char* kFalseAlarm = "healthy radars are named on this drive without a fault";
inline constexpr const char* kOrder = "who contradicts the state is left out, not who changed";
inline constexpr const char* kNoWitness = "positions against Doppler do not decide";
inline constexpr const char* kAllDoubted = "a radar in doubt is used if all are in doubt";
inline constexpr const char* kTime = "nothing compares the times of two buses";
inline constexpr const char* kMajority = "targets that move together are taken for the ground";

inline constexpr auto kNotYet = std::to_array<NotYet>({
    {"healthy 105 unflagged", "AI", "", "traffic beside the own speed is taken for two worlds"},
    {"scale 0.90", "BIU", "U", kOrder},
    {"scale 0.95", "BIU", "B", kOrder},
    {"scale 1.05", "I", "I", kOrder},
    {"scale 1.10", "BIU", "U", kOrder},
    {"alone, scale 0.90", "B", "B", kNoWitness},
    {"alone, scale 1.10", "B", "B", kNoWitness},
    {"sign flipped", "B", "", kFalseAlarm},
    {"upside down", "BIU", "BU", kNoWitness},
    {"mount 5 deg off", "BIU", "", kOrder},
    {"mount 10 deg off", "BIU", "", kOrder},
    {"mount 2 m ahead", "IU", "U", kNoWitness},
    {"buses swapped", "BIU", "", kOrder},
    {"all flipped from 8 s", "B", "B", kAllDoubted},
    {"all flipped for 5 s", "BR", "B", kAllDoubted},
    {"all zero from 8 s", "B", "B", kAllDoubted},
    {"all zero for 5 s", "BR", "B", kAllDoubted},
    {"all repeat from 8 s", "B", "B", kAllDoubted},
    {"all repeat for 5 s", "BR", "B", kAllDoubted},
    {"late 300 ms", "BIU", "", kTime},
    {"late 500 ms", "", "BU", kTime},
    {"stamps 1 s ahead", "BIU", "BU", kTime},
    {"clock step +0.1 s", "BI", "B", kTime},
    {"clock step +0.5 s", "BI", "B", kTime},
    {"clock step +1.0 s", "B", "", kFalseAlarm},
    {"clock step -0.1 s", "BI", "B", kTime},
    {"clock step -0.5 s", "BI", "B", kTime},
    {"clock step -1.0 s", "BI", "B", kTime},
    {"learned mounts wrong", "I", "I", "side radars are left out instead of learned anew"},
    {"learned scales wrong", "B", "", kFalseAlarm},
    {"train", "", "BI", kMajority},
    {"convoy", "", "BI", kMajority},
    {"jam-starts", "", "BI", kMajority},
});

}  // namespace cremed::test
