// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// How much a signal of the vehicle's bus is trusted. Unlike a radar (RadarTrust) it need not be
/// wrong all the time to be wrong: a delayed or wrongly scaled yaw rate agrees on straight roads.
/// So it returns only after a long time of agreement, which doubles each time.
class SignalTrust {
 public:
  /// Contradicting minus agreeing measurements at which a signal is left out: 0.25 s at 20 Hz.
  static constexpr int kMaxContradictions = 5;
  /// Agreeing measurements in a row until it returns: 10 s, and at most 11 minutes.
  static constexpr int kAgreementsToReturn = 200;
  static constexpr int kMostAgreementsToReturn = 64 * kAgreementsToReturn;

  /// Records whether a measurement is as the filter expects.
  void judge(bool is_expected);
  /// Its errors are larger than sensors and radars have them.
  void leave_out();

  [[nodiscard]] bool is_left_out() const { return is_left_out_; }
  [[nodiscard]] int times_left_out() const { return times_left_out_; }

 private:
  int contradictions_ = 0;
  int agreements_ = 0;
  int agreements_to_return_ = kAgreementsToReturn;
  int times_left_out_ = 0;
  bool is_left_out_ = false;
};

}  // namespace cremed
