// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace cremed {

/// Radars, a bit each.
using RadarSet = std::uint32_t;

constexpr RadarSet set_of(std::size_t radar) { return 1U << radar; }
/// The radars 0 to count - 1.
constexpr RadarSet first_radars(std::size_t count) { return set_of(count) - 1U; }
constexpr bool contains(RadarSet set, std::size_t radar) { return (set >> radar & 1U) != 0; }

template <typename Use>
void for_each(RadarSet set, Use use) {
  for (; set != 0; set &= set - 1U) {
    use(static_cast<std::size_t>(std::countr_zero(set)));
  }
}

/// Those radars of a set that pass a test.
template <typename Test>
RadarSet filter(RadarSet set, Test test) {
  RadarSet passing = 0;
  for_each(set, [&](std::size_t radar) { passing |= test(radar) ? set_of(radar) : 0U; });
  return passing;
}

template <typename Test>
bool any_of(RadarSet set, Test test) {
  for (; set != 0; set &= set - 1U) {
    if (test(static_cast<std::size_t>(std::countr_zero(set)))) {
      return true;
    }
  }
  return false;
}

}  // namespace cremed
