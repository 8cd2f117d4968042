// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "test/soak/estimate_checker.hpp"
#include "test/soak/fault_injector.hpp"
#include "test/soak/memory_watch.hpp"

namespace cremed::soak {

using RadarNames = std::vector<std::string>;

void print(const Found& found, const RadarNames& radars);
void print(const Comparison& comparison, const RadarNames& radars);
void print_tallies(const EstimateChecker& checker, const RadarNames& radars);
void print_faults(const FaultInjector& source);

/// All estimates of all radars.
Tally total(const EstimateChecker& checker);
double share_within(const Tally& tally);

}  // namespace cremed::soak
