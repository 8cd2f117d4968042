// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/signal_check.hpp"

namespace cremed {
namespace {

constexpr double kScanS = 0.075;
constexpr double kYawStdRad = 0.0015;

/// Errors of the signal beyond the options.
struct Wrong {
  double offset = 0.0;
  double scale = 1.0;
  double delay_s = 0.0;
};

/// A town: turns of 4 s with up to 0.4 rad/s, every 15 s.
double yaw_rate(double time_s) {
  const double into_s = std::fmod(time_s, 15.0);
  const double side = std::fmod(time_s, 30.0) < 15.0 ? 1.0 : -1.0;
  return into_s < 4.0 ? side * 0.2 * (1.0 - std::cos(1.5707963 * into_s)) : 0.0;
}

double turned_rad(double from_s, double to_s) {
  constexpr int kSteps = 100;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    sum += yaw_rate(from_s + (i + 0.5) * (to_s - from_s) / kSteps);
  }
  return sum * (to_s - from_s) / kSteps;
}

/// A check after a drive with one radar, of true covariance, and a signal at 100 Hz.
SignalCheck after(double duration_s, const Wrong& wrong, double walk_radps = 0.0) {
  const VehicleOptions options;
  SignalCheck check(VehicleSignal::yaw_rate, options);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double next_scan_s = 1.0;
  double walk = 0.0;
  for (int i = 0; i < static_cast<int>(duration_s * 100.0); ++i) {
    const double now_s = 0.01 * i;
    const double measured_s = now_s - options.yaw_rate.delay_s - wrong.delay_s;
    check.add(i * 10'000, wrong.scale * yaw_rate(measured_s) + wrong.offset);
    if (now_s >= next_scan_s + 0.06) {
      const double start_s = next_scan_s - kScanS;
      walk = walk * std::exp(-kScanS / 2.0) +
             walk_radps * std::sqrt(1.0 - std::exp(-kScanS)) * normal(random);
      const double seen =
          turned_rad(start_s, next_scan_s) + kYawStdRad * normal(random) + walk * kScanS;
      check.compare(std::llround(start_s * 1e6), std::llround(next_scan_s * 1e6), seen / kScanS,
                    std::pow(kYawStdRad / kScanS, 2));
      next_scan_s += kScanS;
    }
  }
  return check;
}

TEST_CASE("a sound signal has no fault, whatever the radar errs by for seconds") {
  const double walk_radps = GENERATE(0.0, 0.005);
  const double duration_s = GENERATE(5.0, 60.0, 200.0);
  CHECK(after(duration_s, {}, walk_radps).fault() == SignalFault::none);
  // As large as sensors have it.
  CHECK(after(duration_s, {0.001, 1.01, 0.02}, walk_radps).fault() == SignalFault::none);
}

TEST_CASE("a wrong scale, delay and offset are named, and how large they are") {
  const SignalCheck scaled = after(60.0, {.scale = 1.15}, 0.005);
  CHECK(scaled.fault() == SignalFault::scale);
  CHECK(scaled.errors_by_radars().value(1) == Approx(0.15).margin(0.03));

  const SignalCheck late = after(60.0, {.delay_s = 0.3}, 0.005);
  CHECK(late.fault() == SignalFault::delay);
  CHECK(late.errors_by_radars().value(2) == Approx(0.3).margin(0.05));

  const SignalCheck off = after(30.0, {.offset = 0.05}, 0.005);
  CHECK(off.fault() == SignalFault::offset);
  CHECK(off.errors_by_radars().value(0) == Approx(0.05).margin(0.01));

  CHECK(after(60.0, {.scale = -1.0}).fault() == SignalFault::scale);  // Its sign is wrong.
}

TEST_CASE("what the innovations of the filter tell is a fault as well, until it forgets") {
  const Eigen::Vector3d offset(0.04, 0.0, 0.0);
  SignalCheck check = after(60.0, {}, 0.005);
  const auto tell = [&](double std) {
    const Eigen::Matrix3d information = Eigen::Vector3d(1.0 / (std * std), 1.0, 1.0).asDiagonal();
    check.take(information, information * offset);
  };
  tell(0.02);  // Two sigmas.
  CHECK(check.fault() == SignalFault::none);
  tell(0.005);
  CHECK(check.fault() == SignalFault::offset);
  CHECK(check.find().errors.value(0) == Approx(0.04).margin(0.002));
  CHECK_FALSE(check.is_clear_by_filter());
  CHECK_FALSE(check.is_refuted_by_radars());
  check.take(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero());
  CHECK(check.fault() == SignalFault::none);
  CHECK(check.is_clear_by_filter());
}

TEST_CASE("on a straight road an offset is a fault, though it may be one of scale") {
  SignalCheck check(VehicleSignal::yaw_rate, VehicleOptions());
  for (int i = 0; i < 200; ++i) {
    check.add(i * 75'000, 0.05);
    check.compare((i - 2) * 75'000, (i - 1) * 75'000, 0.0, 4e-4);
  }
  CHECK(check.fault() != SignalFault::none);
}

TEST_CASE("on a straight road nothing is known of scale and delay") {
  const VehicleOptions options;
  SignalCheck check(VehicleSignal::yaw_rate, options);
  for (int i = 0; i < 1000; ++i) {
    check.add(i * 75'000, 0.0);
    check.compare((i - 2) * 75'000, (i - 1) * 75'000, 0.0, 4e-4);
  }
  CHECK(check.errors_by_radars().covariance(1, 1) == Approx(1.0).epsilon(0.01));
  CHECK(check.errors_by_radars().covariance(2, 2) == Approx(1.0).epsilon(0.01));
  CHECK(check.fault() == SignalFault::none);
}

TEST_CASE("scans that waited and came within milliseconds are compared like others") {
  SignalCheck check(VehicleSignal::speed, VehicleOptions());
  for (std::int64_t i = 0; i < 20; ++i) {
    check.add(10'000 * i, 5.0);
  }
  check.compare(50'000, 125'000, 5.0, 0.01);
  const double before = check.errors_by_radars().covariance(1, 1);
  check.compare(125'000, 128'000, 5.0, 0.01);
  CHECK(check.errors_by_radars().covariance(1, 1) < before);
}

}  // namespace
}  // namespace cremed
