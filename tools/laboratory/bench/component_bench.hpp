// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Registers benchmarks "components/N": residuals of 64 points against a mixture of N targets and
/// the outlier ray. Counters, per evaluation of a component: ns, floor_ns (see floor.hpp), ratio.
void register_component_bench();

}  // namespace cremed
