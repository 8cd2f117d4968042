// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed {

/// IFNAMSIZ without its terminating zero.
inline constexpr std::size_t kMaxInterfaceName = 15;

/// How to read frames from an interface.
struct CanSocketOptions {
  int receive_buffer_bytes = 1 << 20;  ///< 1 MiB: about 0.3 s of a full bus at 500 kbit/s.
  /// Use the controller's stamps. If they are missing, run backwards or are not of the system
  /// clock, the kernel's are used from then on.
  bool hardware_stamps = false;

  bool operator==(const CanSocketOptions&) const = default;
};

}  // namespace cremed
