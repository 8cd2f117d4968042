// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// A configuration without interface = "auto".
struct LocatedRadars {
  Configuration configuration;    ///< Interfaces that were found are written in it.
  std::vector<Finding> findings;  ///< Of the radars that were not found: they are left out of it.
};

/// Puts every radar where the live buses show it, as the daemon does: listens for some seconds
/// where that is needed.
LocatedRadars locate_live(const Configuration& configuration,
                          const volatile std::sig_atomic_t* stop);

/// The same of a candump log, which is read once more for it: standard input cannot be. Throws
/// std::runtime_error.
LocatedRadars locate_in_log(const Configuration& configuration, const std::string& path);

}  // namespace cremed
