// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/radar_status.hpp"

namespace cremed {

/// What became of one radar, for people.
struct RadarReport {
  std::string summary;             ///< One line: scans, estimates, what kept the others out.
  std::vector<std::string> hints;  ///< What is wrong and what to do, most likely cause first.
};

RadarReport report(const RadarConfiguration& configuration, RadarChannel& radar,
                   const FrameSource& source);

}  // namespace cremed
