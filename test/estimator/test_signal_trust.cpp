// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/signal_trust.hpp"

namespace cremed {
namespace {

void judge(SignalTrust& trust, bool is_expected, int times) {
  for (int i = 0; i < times; ++i) {
    trust.judge(is_expected);
  }
}

TEST_CASE("a signal is left out when it contradicts five times more than it agrees") {
  SignalTrust trust;
  judge(trust, true, 1000);
  judge(trust, false, 4);
  CHECK_FALSE(trust.is_left_out());
  judge(trust, true, 2);
  judge(trust, false, 2);
  CHECK_FALSE(trust.is_left_out());
  judge(trust, false, 1);
  CHECK(trust.is_left_out());
  CHECK(trust.times_left_out() == 1);
}

TEST_CASE("it returns after agreeing without a break, and after twice as long the next time") {
  SignalTrust trust;
  for (const int needed : {200, 400, 800}) {
    trust.leave_out();
    judge(trust, true, needed - 1);
    CHECK(trust.is_left_out());
    trust.judge(false);
    judge(trust, true, needed - 1);
    CHECK(trust.is_left_out());
    trust.judge(true);
    CHECK_FALSE(trust.is_left_out());
  }
  CHECK(trust.times_left_out() == 3);
}

TEST_CASE("however often it is left out, it may return after eleven minutes") {
  SignalTrust trust;
  for (int i = 0; i < 20; ++i) {
    trust.leave_out();
    judge(trust, true, SignalTrust::kMostAgreementsToReturn);
    CHECK_FALSE(trust.is_left_out());
  }
}

}  // namespace
}  // namespace cremed
