// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Bound of a difference that may be noise, in its standard deviations. By chance one in 370 of a
/// Gaussian exceeds it.
inline constexpr double kGateSigmas = 3.0;

}  // namespace cremed
