// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "daemon/configuration/toml_reader.hpp"

namespace cremed {

/// Reads [estimator] or [radar.estimator]; absent keys keep the values in `options`.
void read_estimator(TomlReader reader, EgoMotionOptions& options);

}  // namespace cremed
