// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// An ARS408's use of the received motion, and the true mounts.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "test/tools/seen_from.hpp"
#include "test/tools/simulated_drive.hpp"
#include "tools/simulate/told_motion.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr double kLeadS = 0.04;
const Pose2 kLeftMount{3.4, 0.6, 0.4};

/// A target and its position in the world, by the truth file alone. Positions are in the radar's
/// frame, 10 ms before the stamp, at it and 10 ms after.
struct Seen {
  Detection detection;
  EchoKind kind;
  Polar before;
  Polar now;
  Polar after;
  double yaw_rate_radps;

  /// Velocity in the direction `angle_rad`, if the target is static.
  [[nodiscard]] double static_mps(double angle_rad) const {
    return (after.range_m * std::cos(after.azimuth_rad - angle_rad) -
            before.range_m * std::cos(before.azimuth_rad - angle_rad)) /
           0.02;
  }
  [[nodiscard]] double static_across_mps() const {
    return static_mps(now.azimuth_rad + 0.5 * M_PI);
  }
  /// The reported velocity across the line of sight `azimuth_rad`.
  [[nodiscard]] double across_mps(double azimuth_rad) const {
    const double off_rad = detection.azimuth_rad - azimuth_rad;
    return detection.doppler_mps * std::sin(off_rad) + detection.across_mps * std::cos(off_rad);
  }
  /// Positive if the reported position is too far to the left.
  [[nodiscard]] double azimuth_error_rad() const {
    return std::remainder(detection.azimuth_rad - now.azimuth_rad, 2.0 * M_PI);
  }
};

Seen seen_at(const Detection& detection, const Echo& echo, const TruthTable& truth,
             std::int64_t stamp_us) {
  const auto vehicle = [&](double offset_us) {
    return truth.at(static_cast<double>(stamp_us) + offset_us);
  };
  const auto place = [&](double offset_us) {
    return seen_from(vehicle(offset_us), kLeftMount, echo.x_m, echo.y_m);
  };
  return {detection,        echo.kind,
          place(-10'000.0), place(0.0),
          place(10'000.0),  (vehicle(10'000.0).yaw_rad - vehicle(-10'000.0).yaw_rad) / 0.02};
}

Drive told_drive(const char* name, bool is_told, double duration_s = 40.0,
                 double azimuth_scale = 1.0) {
  SimulationOptions options;
  options.is_told_motion = is_told;
  options.duration_s = duration_s;
  options.body_velocity_std_mps = 0.0;
  RadarConfiguration front = radar("front", "can0", kLeftMount, Ars408Options{});
  front.ego_motion.correction.azimuth_scale = azimuth_scale;
  return drive(scenario(name), {front}, exactly_mounted(options));
}

/// All targets but ghosts, which have no position.
std::vector<Seen> all_seen(const Drive& drive) {
  const TruthTable truth(drive.truth_csv);
  const auto scans = decode(drive.log(), drive.radars[0]).scans;
  REQUIRE(scans.size() == drive.truths.size());
  std::vector<Seen> all;
  for (std::size_t k = 1; k + 1 < scans.size(); ++k) {
    for (std::size_t i = 0; i < scans[k].count; ++i) {
      const Echo& echo = drive.truths[k].echoes[i];
      if (echo.kind == EchoKind::ghost) continue;
      all.push_back(seen_at(scans[k].detections[i], echo, truth, scans[k].stamp_us));
    }
  }
  return all;
}

using Value = std::function<double(const Seen&)>;

/// Least-squares slope of `y` on `x` over the selected targets.
double slope(const std::vector<Seen>& all, const Value& x, const Value& y,
             const std::function<bool(const Seen&)>& is_asked) {
  double products = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (const Seen& seen : all) {
    if (!is_asked(seen)) continue;
    products += x(seen) * y(seen);
    squares += x(seen) * x(seen);
    ++count;
  }
  REQUIRE(count > 500);
  return products / squares;
}

double yaw_rate(const Seen& seen) { return seen.yaw_rate_radps; }
double azimuth_error(const Seen& seen) { return seen.azimuth_error_rad(); }
double static_across(const Seen& seen) { return seen.static_across_mps(); }
bool turns_left(const Seen& seen) { return seen.yaw_rate_radps > 0.2; }
bool turns_right(const Seen& seen) { return seen.yaw_rate_radps < -0.2; }
bool drives_straight(const Seen& seen) { return std::abs(seen.yaw_rate_radps) < 0.01; }

}  // namespace

TEST_CASE("The velocity across is how a standing point moves in the radar's frame") {
  const VehicleCourse course(scenario("u-turn").course, 60.0);
  for (double time_s = 0.1; time_s < 50.0; time_s += 0.37) {
    for (const double bearing_rad : {-2.0, -0.3, 0.0, 0.9, 3.0}) {
      const VehicleState state = course.at(time_s);
      const double x_m = state.pose.x_m + 20.0 * std::cos(bearing_rad);
      const double y_m = state.pose.y_m + 20.0 * std::sin(bearing_rad);
      const Polar before = seen_from(course.at(time_s - 1e-3).pose, kLeftMount, x_m, y_m);
      const Polar now = seen_from(state.pose, kLeftMount, x_m, y_m);
      const Polar after = seen_from(course.at(time_s + 1e-3).pose, kLeftMount, x_m, y_m);
      const double expected_mps =
          now.range_m * std::remainder(after.azimuth_rad - before.azimuth_rad, 2.0 * M_PI) / 2e-3;
      const double across_mps = static_across_mps({state.speed_mps, state.yaw_rate_radps},
                                                  kLeftMount, now.range_m, now.azimuth_rad);
      REQUIRE(across_mps == Approx(expected_mps).margin(1e-3));
    }
  }
}

TEST_CASE("What a vehicle tells is what it measured 10 to 20 ms ago, nearly") {
  const VehicleCourse course(scenario("u-turn").course, 60.0);
  const VehicleBus bus(course, Random(1, 0), Random(1, 1));
  double speed_square = 0.0;
  double yaw_rate_square = 0.0;
  double number = 0.0;
  for (double time_s = 0.1; time_s < 60.0; time_s += 0.0173) {
    const ToldMotion told = bus.at(time_s);
    const VehicleState measured = course.at(time_s - 0.015);
    REQUIRE(std::abs(std::remainder(told.speed_mps, 0.02)) < 1e-9);
    REQUIRE(std::abs(std::remainder(told.yaw_rate_radps, 0.01 * kRadPerDeg)) < 1e-9);
    speed_square += std::pow(told.speed_mps - measured.speed_mps, 2.0);
    yaw_rate_square += std::pow(told.yaw_rate_radps - measured.yaw_rate_radps, 2.0);
    number += 1.0;
  }
  CHECK(std::sqrt(speed_square / number) == Approx(0.02).epsilon(0.35));
  CHECK(std::sqrt(yaw_rate_square / number) == Approx(0.15 * kRadPerDeg).epsilon(0.35));
}

TEST_CASE("An ARS408 that is told tells how a standing target moves across, of moving ones too") {
  const auto all = all_seen(told_drive("garage", true, 58.0));
  const auto across = [](const Seen& seen) {
    return seen.across_mps(seen.detection.azimuth_rad + kLeadS * seen.yaw_rate_radps);
  };
  CHECK(slope(all, static_across, across, turns_left) == Approx(1.0).margin(0.01));
  CHECK(slope(all, static_across, across, turns_right) == Approx(1.0).margin(0.01));

  const auto city = all_seen(told_drive("crowd", true, 60.0));
  const auto moves = [](const Seen& seen) { return seen.kind == EchoKind::vehicle; };
  const auto stands = [](const Seen& seen) { return seen.kind == EchoKind::fixed; };
  CHECK(slope(city, static_across, across, moves) == Approx(1.0).margin(0.02));
  CHECK(slope(city, static_across, across, stands) == Approx(1.0).margin(0.02));
}

TEST_CASE("Positions are turned ahead, against the vehicle's turn, by 40 ms; ranges are not") {
  const auto all = all_seen(told_drive("garage", true, 58.0));
  CHECK(slope(all, yaw_rate, azimuth_error, turns_left) == Approx(-kLeadS).margin(0.004));
  CHECK(slope(all, yaw_rate, azimuth_error, turns_right) == Approx(-kLeadS).margin(0.004));
  const auto range = [](const Seen& seen) { return seen.now.range_m; };
  const auto reported = [](const Seen& seen) { return seen.detection.range_m; };
  CHECK(slope(all, range, reported, turns_left) == Approx(1.0).margin(0.003));
}

TEST_CASE("On the reported line of sight Doppler has too much by tau w^2 r") {
  const auto all = all_seen(told_drive("roundabout", true, 30.0));
  const auto predicted = [](const Seen& seen) {
    return kLeadS * seen.yaw_rate_radps * seen.yaw_rate_radps * seen.now.range_m;
  };
  // Expectation of a static target at the reported place, without the turn's own contribution.
  const auto bias = [](const Seen& seen) {
    const double lead_rad = kLeadS * seen.yaw_rate_radps;
    const double translation_mps =
        seen.static_across_mps() + seen.yaw_rate_radps * seen.now.range_m;
    return seen.detection.doppler_mps -
           (seen.static_mps(seen.now.azimuth_rad) - lead_rad * translation_mps);
  };
  const auto stands_in_turn = [](const Seen& seen) {
    return seen.kind == EchoKind::fixed && turns_left(seen);
  };
  CHECK(slope(all, predicted, bias, stands_in_turn) == Approx(1.0).margin(0.15));
}

TEST_CASE(
    "An ARS408 that is told nothing sends radial velocities, unturned, and all seems to move") {
  const Drive drive = told_drive("garage", false, 58.0);
  const auto all = all_seen(drive);
  for (const Seen& seen : all) {
    // Half a step of both grids, in the worst direction.
    const double rounding_rad = 0.1 * M_SQRT2 / seen.detection.range_m;
    REQUIRE(std::abs(seen.detection.across_mps) <
            0.125 * M_SQRT2 + 1.01 * rounding_rad * std::abs(seen.detection.doppler_mps) + 1e-6);
    const bool moves = std::abs(seen.static_mps(seen.now.azimuth_rad)) > 0.55;
    if (moves) REQUIRE(seen.detection.motion == Motion::moving);
  }
  CHECK(slope(all, yaw_rate, azimuth_error, turns_left) == Approx(0.0).margin(0.004));
  CHECK(slope(all, yaw_rate, azimuth_error, turns_right) == Approx(0.0).margin(0.004));

  const auto decoder = drive.radars[0].decoder.make_decoder();
  for (const CanFrame& frame : drive.frames) decoder->decode(frame);
  CHECK((decoder->health().faults & RadarHealth::speed_missing) != 0);
  CHECK((decoder->health().faults & RadarHealth::yaw_rate_missing) != 0);
}

TEST_CASE("Straight on nothing is turned") {
  const auto all = all_seen(told_drive("straight", true, 20.0));
  const auto one = [](const Seen&) { return 1.0; };
  CHECK(slope(all, one, azimuth_error, drives_straight) == Approx(0.0).margin(3e-4));
}

TEST_CASE("Mounts are off by what is asked for, by seed, each radar by itself") {
  const auto radars = default_radars();
  const auto mounts = [&](std::uint64_t seed, const std::vector<RadarConfiguration>& of) {
    SimulationOptions options;
    options.seed = seed;
    options.duration_s = 1.0;
    return Simulation(scenario("standing"), of, options).mounts();
  };
  double yaw_square = 0.0;
  double position_square = 0.0;
  double alike = 0.0;  // Drives in which both mounts are turned in the same direction.
  constexpr std::uint64_t kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto real = mounts(seed, radars);
    for (std::size_t i = 0; i < radars.size(); ++i) {
      const Pose2& stated = radars[i].ego_motion.vehicle_from_radar;
      yaw_square += std::pow(real[i].yaw_rad - stated.yaw_rad, 2.0);
      position_square += std::pow(real[i].x_m - stated.x_m, 2.0);
      position_square += std::pow(real[i].y_m - stated.y_m, 2.0);
    }
    const double difference_rad = real[1].yaw_rad - real[0].yaw_rad;
    alike += std::abs(std::remainder(difference_rad - M_PI, 2.0 * M_PI)) < 1e-9 ? 1.0 : 0.0;
  }
  CHECK(std::sqrt(yaw_square / (2.0 * kSeeds)) == Approx(0.005));
  CHECK(std::sqrt(position_square / (4.0 * kSeeds)) == Approx(0.01));
  CHECK(alike / kSeeds == Approx(0.5).margin(0.15));  // 4 sigma.
  CHECK(mounts(7, radars)[0].yaw_rad == mounts(7, radars)[0].yaw_rad);
  CHECK(mounts(7, {radars[0]})[0].yaw_rad == mounts(7, radars)[0].yaw_rad);
}

TEST_CASE("What a radar sees is seen from where it really is") {
  SimulationOptions options;
  options.duration_s = 5.0;
  const Drive drive = cremed::test::drive(scenario("bends"), default_radars(), options);
  const TruthTable truth(drive.truth_csv);
  for (const ScanTruth& scan : drive.truths) {
    const Pose2 vehicle = truth.at(static_cast<double>(scan.stamp_us));
    for (const Echo& echo : scan.echoes) {
      if (echo.kind == EchoKind::ghost) continue;
      const Polar place = seen_from(vehicle, drive.mounts[scan.radar], echo.x_m, echo.y_m);
      REQUIRE(echo.view.range_m == Approx(place.range_m).margin(1e-3));
      REQUIRE(std::remainder(echo.view.azimuth_rad - place.azimuth_rad, 2.0 * M_PI) ==
              Approx(0.0).margin(1e-4));
    }
  }
}

TEST_CASE(
    "A radar with an azimuth scale measures smaller azimuths, and Doppler where the target is") {
  constexpr double kScale = 1.05;
  const auto all = all_seen(told_drive("city", true, 40.0, kScale));
  const auto azimuth = [](const Seen& seen) { return seen.now.azimuth_rad; };
  const auto reported = [](const Seen& seen) { return seen.detection.azimuth_rad; };
  const auto doppler = [](const Seen& seen) { return seen.detection.doppler_mps; };
  const auto true_doppler = [](const Seen& seen) { return seen.static_mps(seen.now.azimuth_rad); };
  const auto stands = [](const Seen& seen) {
    return seen.kind == EchoKind::fixed && drives_straight(seen);
  };
  CHECK(slope(all, azimuth, reported, stands) == Approx(1.0 / kScale).margin(0.003));
  CHECK(slope(all, true_doppler, doppler, stands) == Approx(1.0).margin(0.002));
}
