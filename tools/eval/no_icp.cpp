// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "tools/eval/icp.hpp"

namespace cremed {

// In place of icp.cpp where PCL is not installed.
const bool kHasIcp = false;

RegistrationResult register_icp(const TargetSet&, const TargetSet&, const RegistrationContext&) {
  throw std::runtime_error(kNoIcp);
}

}  // namespace cremed
