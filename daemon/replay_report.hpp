// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/configuration/configuration.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/report/odometry_tally.hpp"
#include "daemon/source/replay.hpp"

namespace cremed {

/// What is reported.
struct Replayed {
  const std::string& configuration_path;
  const Configuration& configuration;
  const Pipeline& pipeline;
  const Replay& replay;
  const OdometryTally& odometry;
  bool is_stopped = false;  ///< By a signal: what is missing may have come.
};

/// Logs the result of a replay, causes of faults first. False if it has a fault: a log that could
/// not be read or has no times, a radar without a scan, no estimate at all.
bool report_replay(const Replayed& replayed);

}  // namespace cremed
