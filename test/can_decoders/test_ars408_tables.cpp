// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <initializer_list>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_tables.hpp"

namespace cremed {
namespace {

double to_thousandths(double value) { return std::round(value * 1000.0) / 1000.0; }

TEST_CASE("Table R is a geometric series rounded to thousandths") {
  for (std::uint8_t index = 0; index <= 30; ++index) {
    INFO(int{index});
    CHECK(ars408_rms(index).value() ==
          Approx(to_thousandths(0.005 * std::pow(2000.0, index / 30.0))).epsilon(1e-12));
  }
}

TEST_CASE("The deviation to reckon with is the root mean square of those an index stands for") {
  for (std::uint8_t index = 1; index <= 30; ++index) {
    INFO(int{index});
    const double high = 0.005 * std::pow(2000.0, index / 30.0);
    const double low = 0.005 * std::pow(2000.0, (index - 1) / 30.0);
    double sum = 0.0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
      const double std = low * std::pow(high / low, (i + 0.5) / kSteps);
      sum += std * std;
    }
    CHECK(ars408_std(index).value() == Approx(std::sqrt(sum / kSteps)).epsilon(1e-3).margin(5e-4));
  }
}

TEST_CASE("Rms index 31 and impossible ones have no value") {
  for (const std::uint8_t index : std::initializer_list<std::uint8_t>{31, 32, 255}) {
    INFO(int{index});
    CHECK_FALSE(ars408_rms(index).has_value());
    CHECK_FALSE(ars408_std(index).has_value());
  }
}

TEST_CASE("Codes of tables D, I, M and of the measurement state") {
  // The codes are the sensor's; the configuration's masks use them.
  CHECK(Ars408DynProp{0} == Ars408DynProp::moving);
  CHECK(Ars408DynProp{1} == Ars408DynProp::stationary);
  CHECK(Ars408DynProp{2} == Ars408DynProp::oncoming);
  CHECK(Ars408DynProp{3} == Ars408DynProp::stationary_candidate);
  CHECK(Ars408DynProp{4} == Ars408DynProp::unknown);
  CHECK(Ars408DynProp{5} == Ars408DynProp::crossing_stationary);
  CHECK(Ars408DynProp{6} == Ars408DynProp::crossing_moving);
  CHECK(Ars408DynProp{7} == Ars408DynProp::stopped);
  CHECK(Ars408InvalidState{0x04} == Ars408InvalidState::low_rcs);
  CHECK(Ars408InvalidState{0x07} == Ars408InvalidState::outside_field_of_view);
  CHECK(Ars408InvalidState{0x0B} == Ars408InvalidState::no_local_maximum);
  CHECK(Ars408InvalidState{0x0E} == Ars408InvalidState::harmonic);
  CHECK(Ars408InvalidState{0x11} == Ars408InvalidState::suspicious_angle);
  CHECK(Ars408Ambiguity{3} == Ars408Ambiguity::unambiguous);
  CHECK(Ars408MeasurementState{0} == Ars408MeasurementState::deleted);
  CHECK(Ars408MeasurementState{4} == Ars408MeasurementState::deleted_for_merge);
}

}  // namespace
}  // namespace cremed
