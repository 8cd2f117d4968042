// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// CLOCK_MONOTONIC: for durations.
std::int64_t monotonic_us();

/// CLOCK_REALTIME: the clock of the stamps. It may jump.
std::int64_t realtime_us();

/// Returns earlier at a signal; at once if the duration is not positive. Less than a second.
void sleep_us(std::int64_t duration_us);

}  // namespace cremed
