// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Notices that the system's clock was set (by NTP, by hand, by waking up), however little: frames'
/// stamps are of that clock, so no time may be measured across such a step. Slewing is no step.
class ClockWatch {
 public:
  ClockWatch();
  ~ClockWatch();
  ClockWatch(const ClockWatch&) = delete;
  ClockWatch& operator=(const ClockWatch&) = delete;

  /// Readable when the clock was set; -1 if the kernel cannot tell.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// Was the clock set since the last call? Does not wait.
  bool was_set();

 private:
  void arm();

  int descriptor_;
};

}  // namespace cremed
