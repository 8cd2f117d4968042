// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/radar_status.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// Number of estimates so far.
std::uint64_t estimates(const RadarStatus& status);

/// One line: scans, estimates, and the statuses of the others.
std::string summary(const RadarStatus& status);

/// One line: every non-zero counter of bad frames and incomplete scans; empty if all are zero.
std::string irregularities(const RadarStatus& status);

/// Causes of missing or bad odometry that the pipeline can detect, most likely first. `all`: the
/// configuration's radars, for their names.
std::vector<Finding> radar_findings(const RadarConfiguration& radar, const RadarStatus& status,
                                    std::span<const RadarConfiguration> all);

/// What is wrong with a radar that the odometry leaves out, or of which it learned the mount, and
/// what corrects it, as far as known.
Finding fault_finding(const RadarConfiguration& radar, const RadarStatus& status,
                      std::span<const RadarConfiguration> all);

/// An error if others have the mount of a radar, as in a file that was not filled in, and the
/// common odometry or its own positions contradict it. What follows from that radar_findings()
/// leaves out.
std::optional<Finding> common_mount(const Configuration& configuration,
                                    const RadarConfiguration& radar, const RadarStatus& status);

/// Whether radar_findings() or common_mount() name what is wrong with its mount or its Doppler:
/// missing estimates follow from that.
bool is_contradicted(const RadarConfiguration& radar, const RadarStatus& status,
                     std::span<const RadarConfiguration> all);

/// For a single radar that reversed for all of a drive: the yaw that the filter learns with a mount
/// that is turned by pi is another wrong one.
void drop_doubts_of_turned_mount(RadarStatus& status);

/// What configures an ARS408 as expected, in backquotes.
std::string configure_command(const RadarConfiguration& radar);

/// Faults and settings that the sensor reports.
std::vector<Finding> health_findings(const RadarConfiguration& radar, const RadarStatus& status);

}  // namespace cremed
