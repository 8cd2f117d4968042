// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/state/error_table.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

using namespace state_layout;

const std::vector<Pose2> kFrontLeftRear{{3.4, 0.0, 0.0}, {2.4, 0.8, 1.5}, {-0.6, 0.6, 3.1}};

OdometryOptions with_signals() {
  OdometryOptions options;
  options.vehicle.speed.is_used = options.vehicle.yaw_rate.is_used = true;
  return options;
}

/// All rows of a state of the radars at kFrontLeftRear and both signals.
std::vector<StateError> rows(const OdometryOptions& options) {
  std::vector<StateError> result = common_errors(options);
  const auto add = [&](const std::vector<StateError>& errors) {
    result.insert(result.end(), errors.begin(), errors.end());
  };
  for (std::size_t i = 0; i < kFrontLeftRear.size(); ++i) {
    add(radar_errors(options, kFrontLeftRear[i], radar(static_cast<int>(i))));
  }
  const int signals = size(static_cast<int>(kFrontLeftRear.size()));
  add(signal_errors(options.vehicle, VehicleSignal::speed, signals));
  add(signal_errors(options.vehicle, VehicleSignal::yaw_rate, signals));
  return result;
}

void advance_all(OdometryState& state, double dt_s) {
  state.advance_to(state.time_us() + std::llround(1e6 * dt_s));
  for (std::size_t i = 0; i < kFrontLeftRear.size(); ++i) {
    state.advance_errors(i, dt_s);
  }
  state.advance_signal(VehicleSignal::speed, dt_s);
  state.advance_signal(VehicleSignal::yaw_rate, dt_s);
}

TEST_CASE("every state but pose, motion and clones has one row of the table of errors") {
  const OdometryOptions options = with_signals();
  std::multiset<int> found;
  for (const StateError& error : rows(options)) {
    found.insert(error.state);
  }
  std::multiset<int> expected{
      kSlip,        kSlipPerAcceleration, kBodyVelocity,   kRounding, kMixture, kCommonAzimuthScale,
      kCommonScale, kCommonYawPerMetre,   kCommonXPerMetre};
  for (int i = kFirstRadar; i < OdometryState(options, kFrontLeftRear).gaussian.size(); ++i) {
    expected.insert(i);
  }
  CHECK(found == expected);
}

TEST_CASE("sixteen radars and the vehicle's signals are not too many states") {
  const std::vector<Pose2> mounts(16, kFrontLeftRear[0]);
  CHECK_NOTHROW(OdometryState(with_signals(), mounts));
}

TEST_CASE("every error starts with its prior, and keeps it as long as the vehicle rests") {
  const OdometryOptions options = with_signals();
  OdometryState state(options, kFrontLeftRear);
  state.start();
  constexpr double kAgeS = 3.0;
  for (const StateError& error : rows(options)) {
    CAPTURE(error.name, error.state);
    CHECK(state.gaussian.variance(error.state) == squared(error.std_at(0.0, 0.0)));
  }
  advance_all(state, kAgeS);
  for (const StateError& error : rows(options)) {
    CAPTURE(error.name, error.state);
    CHECK(state.gaussian.variance(error.state) ==
          Approx(squared(error.std_at(0.0, 0.0)) + squared(error.process.walk) * kAgeS));
  }
}

TEST_CASE("the errors of a vehicle that turns grow to the process of their row") {
  const OdometryOptions options = with_signals();
  OdometryState state(options, kFrontLeftRear);
  state.start();
  state.start_motion({12.0, -0.3}, Eigen::Matrix2d::Zero());
  for (int i = 0; i < 200; ++i) {
    advance_all(state, 100.0);
  }
  for (const StateError& error : rows(options)) {
    if (error.process.walk == 0.0) {
      CAPTURE(error.name, error.state);
      CHECK(state.gaussian.variance(error.state) == Approx(squared(error.std_at(12.0, -0.3))));
    }
  }
}

TEST_CASE("doubt widens what it should, a restart resets what passes") {
  const OdometryOptions options;
  OdometryState state(options, kFrontLeftRear);
  state.start();
  const std::vector<StateError> errors = radar_errors(options, kFrontLeftRear[1], radar(1));
  const auto learn = [&] {
    for (const StateError& error : errors) {
      state.gaussian.set(error.state, 0.01, 1e-12);
    }
  };
  using Reset = StateError::Reset;
  const auto check = [&](auto is_wide, auto is_zero) {
    for (const StateError& error : errors) {
      CAPTURE(error.name);
      CHECK(state.gaussian.variance(error.state) ==
            (is_wide(error.reset) ? squared(error.std_at(0.0, 0.0)) : 1e-12));
      CHECK(state.gaussian.mean(error.state) == (is_zero(error.reset) ? 0.0 : 0.01));
    }
  };
  const auto passes = [](Reset reset) { return reset == Reset::scene; };
  learn();
  state.widen_errors(1);
  check([](Reset reset) { return reset != Reset::never; }, passes);
  learn();
  state.restart(0);
  check(passes, passes);
}

/// A row as README has it.
std::string text(const StateError& error) {
  static constexpr const char* kResets[] = {"", "doubt", "restart"};
  const ErrorProcess& process = error.process;
  std::ostringstream out;
  out.precision(4);
  out << "| " << error.name << " | " << process.std << " | ";
  if (process.walk > 0.0) {
    out << "walk, " << process.walk << " per sqrt(s)";
  } else if (std::isfinite(process.time_s)) {
    out << process.time_s << " s" << (process.only_driving ? " of driving" : "");
  }
  out << " | ";
  const char* separator = "";
  const auto grows = [&](double value, const char* by) {
    if (value > 0.0) {
      out << separator << value << by;
      separator = ", ";
    }
  };
  grows(process.per_yaw_rate, " per rad/s");
  grows(process.per_lateral_acceleration, " per m/s^2");
  grows(process.per_speed_across, " per m/s across");
  grows(process.if_across, " across");
  out << " | " << kResets[static_cast<int>(error.reset)] << " | ";
  switch (error.considered_by) {
    case StateError::kAll:
      out << "all";
      break;
    case StateError::kAllButX:
      out << "all but x by positions";
      break;
    case StateError::kPositions:
      out << "positions";
      break;
    case StateError::kAtRest:
      out << "all at rest";
      break;
    default:
      break;
  }
  out << " |";
  return out.str();
}

TEST_CASE("README has the table of errors") {
  std::ifstream file(CREMED_SOURCE_DIR "/estimator/README.md");
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  std::string table;
  const std::vector<StateError> all = rows(with_signals());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int state = all[i].state;
    if (state < radar(1) || state >= size(static_cast<int>(kFrontLeftRear.size()))) {
      table += text(all[i]) + "\n";
    }
  }
  INFO("README shall have:\n" << table);
  CHECK(readme.find(table) != std::string::npos);
}

}  // namespace
}  // namespace cremed
