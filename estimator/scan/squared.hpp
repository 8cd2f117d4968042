// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

inline double squared(double value) { return value * value; }

}  // namespace cremed
