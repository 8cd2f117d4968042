// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/signal_trust.hpp"

#include <algorithm>

namespace cremed {

void SignalTrust::judge(bool is_expected) {
  if (!is_left_out_) {
    contradictions_ = std::max(contradictions_ + (is_expected ? -1 : 1), 0);
    if (contradictions_ == kMaxContradictions) {
      leave_out();
    }
    return;
  }
  agreements_ = is_expected ? agreements_ + 1 : 0;
  if (agreements_ == agreements_to_return_) {
    is_left_out_ = false;
    contradictions_ = 0;
    agreements_to_return_ = std::min(2 * agreements_to_return_, kMostAgreementsToReturn);
  }
}

void SignalTrust::leave_out() {
  is_left_out_ = true;
  agreements_ = 0;
  ++times_left_out_;
}

}  // namespace cremed
