// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace cremed {

struct CalibrateArguments {
  std::vector<std::string> logs;
  std::string config;
  std::string truth;   ///< Empty: none.
  bool write = false;  ///< Writes the result into the configuration too.
};

/// cremed-eval calibrate: a table on standard error, TOML on standard output. Throws
/// std::runtime_error.
void run_calibrate(const CalibrateArguments& arguments);

}  // namespace cremed
