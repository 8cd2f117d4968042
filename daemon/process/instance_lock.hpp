// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// Prevents a second live instance with one configuration, which would send every message twice.
/// The lock is of a file in the runtime directory that only the same user and root can open: no
/// other user can hold it, or sees who does. The kernel releases it however the process ends.
/// Network namespaces, which have their own buses, have their own locks.
class InstanceLock {
 public:
  /// Locks the configuration at that path. Throws std::runtime_error if another process holds it.
  explicit InstanceLock(const std::string& configuration_path);

 private:
  Descriptor descriptor_;
};

}  // namespace cremed
