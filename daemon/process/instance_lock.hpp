// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Two live instances with one configuration would send every message twice: each holds the name of
/// its configuration as an abstract socket. The kernel gives it back however the process ends, and
/// it needs no folder that all users can write; instances in different network namespaces, whose
/// buses differ too, do not see each other.
class InstanceLock {
 public:
  /// Of the configuration at that path. Throws UsageError if another process has it.
  explicit InstanceLock(const std::string& configuration_path);
  ~InstanceLock();
  InstanceLock(const InstanceLock&) = delete;
  InstanceLock& operator=(const InstanceLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace cremed
