// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed {

/// Linux allows no more (IFNAMSIZ without its terminating zero).
inline constexpr std::size_t kMaxInterfaceName = 15;

/// How frames are read from an interface.
struct CanSocketOptions {
  int receive_buffer_bytes = 1 << 20;  ///< 1 MiB: some 0.3 s of a full bus of 500 kbit/s.
  /// Stamps of the controller instead of the kernel's. Where they are missing, run backwards or are
  /// of another clock than the system's, the kernel's are used from then on.
  bool hardware_stamps = false;
};

}  // namespace cremed
