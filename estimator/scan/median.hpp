// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace cremed {

/// The upper median of a range; `otherwise` of an empty one. Reorders the range.
template <typename Iterator>
double median_or(double otherwise, Iterator first, Iterator last) {
  if (first == last) {
    return otherwise;
  }
  const Iterator middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

}  // namespace cremed
