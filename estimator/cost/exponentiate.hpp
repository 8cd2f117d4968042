// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace cremed {

/// Replaces each number, at most 0, by its exponential, to a few units in the last place; below
/// -600 by exp(-600). Uses the widest vectors of this machine; all give bit-identical results.
void exponentiate(std::span<double> numbers);

}  // namespace cremed
