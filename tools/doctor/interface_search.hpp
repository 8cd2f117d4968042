// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// A configuration with "auto" resolved.
struct LocatedRadars {
  Configuration configuration;    ///< With the interfaces found.
  std::vector<Finding> findings;  ///< One for each radar not found, which `configuration` omits.
};

/// Finds every radar's interface as the daemon does; listens for a few seconds if needed.
LocatedRadars locate_live(const Configuration& configuration,
                          const volatile std::sig_atomic_t* stop);

/// The same for the candump logs of one drive, which are read an extra time and so must not be
/// standard input. Throws std::runtime_error.
LocatedRadars locate_in_logs(const Configuration& configuration,
                             const std::vector<std::string>& paths);

}  // namespace cremed
