// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// The diagnosis as one JSON object, for scripts.
std::string diagnosis_json(const Configuration& configuration, const Observation& observation,
                           const std::vector<Finding>& findings);

}  // namespace cremed
