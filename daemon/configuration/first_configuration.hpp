// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace cremed {

/// How one who has no configuration gets a first one; for messages.
inline constexpr std::string_view kWriteFirst =
    "`cremed-doctor --suggest-config > my.toml` writes a first one from the buses, and with "
    "`--replay LOG` from a log";

/// The same up to the odometry; last lines of --help, as help2man takes them for the manual page.
inline constexpr const char* kFirstSteps =
    "Examples:\n"
    "  From a log to its odometry; this one is installed, `candump -l any` records yours.\n"
    "    $ LOG=/usr/share/cremed/examples/town.log\n"
    "    $ cremed-doctor --replay $LOG --suggest-config > my.toml  # then fill in the mounts\n"
    "    $ cremed --config my.toml --replay $LOG --output-odometry state.csv  # the state at each "
    "scan\n"
    "\n"
    "Files:\n"
    "  /etc/cremed/cremed.toml     Configuration of the service; cremed.toml(5) explains each key\n"
    "  /usr/share/cremed/config    Configurations to start from\n"
    "  /usr/share/cremed/examples  A drive of a minute, town.log, and its truth, town.csv";

}  // namespace cremed
