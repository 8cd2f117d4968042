// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Time from one stamp to another. In double, where no stamp overflows; stamps of this age of the
/// world are exact in it.
inline double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return (static_cast<double>(to_us) - static_cast<double>(from_us)) * 1e-6;
}

}  // namespace cremed
