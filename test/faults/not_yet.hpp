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

inline constexpr auto kNotYet = std::to_array<NotYet>({
    {"none", "", "", ""},
});

}  // namespace cremed::test
