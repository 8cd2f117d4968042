// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bitset>

namespace cremed {

/// Standard CAN identifiers.
using IdSet = std::bitset<0x800>;

}  // namespace cremed
