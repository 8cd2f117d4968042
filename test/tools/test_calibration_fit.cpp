// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/held_out_check.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kBeginUs = 1'700'000'000'000'000;
constexpr CalibrationVector kWide = {0.5, 0.5, 0.5, 0.5, 0.05, 1e-3, 0.05, 0.05, 1e-3, 1e-3};

struct Vehicle {
  static double v_mps(double t_s) { return 8.0 + 2.0 * std::sin(0.7 * t_s); }
  static double w_radps(double t_s) { return 0.3 * std::sin(0.5 * t_s); }
  static double no_slip(double) { return 0.0; }
};

/// A minute of three radars with independent noise; `truths` are their true states. Its last 10 s
/// may be in another log, a pause later.
class RadarMinute {
 public:
  RadarMinute(std::vector<CalibrationVector> truths, unsigned seed, std::int64_t pause_us = 0,
              double (*slip)(double t_s) = Vehicle::no_slip)
      : truths_(std::move(truths)), pause_us_(pause_us), slip_(slip), random_(seed) {
    for (std::size_t radar = 0; radar < truths_.size(); ++radar) {
      for (std::int64_t us = 20'000 * static_cast<std::int64_t>(radar + 1); us < 60'000'000;
           us += 75'000) {
        add(radar, us);
      }
    }
  }

  [[nodiscard]] CalibrationFit fit(const CalibrationVector& error, double slip_std = 0.0) const {
    std::vector<FittedRadar> radars;
    for (std::size_t radar = 0; radar < truths_.size(); ++radar) {
      CalibrationVector start = truths_[radar];
      CalibrationVector std = kWide;
      for (std::size_t i = 0; i < start.size(); ++i) {
        const bool is_reference = radar == 0 && (i == kY || i == kStamp);
        start[i] += is_reference ? 0.0 : error[i];
        std[i] = is_reference ? 0.0 : std[i];
      }
      radars.push_back({start, std, start, {}});
    }
    CalibrationFit result(radars, {.prior_std = {0.0, slip_std}}, {});
    result.set_measurements(velocities_, yaw_rates_);
    return result;
  }

 private:
  void add(std::size_t radar, std::int64_t us) {
    const CalibrationVector& truth = truths_[radar];
    const double t_s = static_cast<double>(us) * 1e-6 + truth[kStamp];
    const double v = Vehicle::v_mps(t_s);
    const double w = Vehicle::w_radps(t_s);
    const double x = v - w * truth[kY];
    const double y = w * truth[kX] - slip_(t_s) * v * v * w;
    const double c = std::cos(truth[kYaw]);
    const double s = std::sin(truth[kYaw]);
    const DopplerState state(c * x + s * y, c * y - s * x, truth[kOffset], 0.0, truth[kLead]);
    DopplerEquations equations;
    equations.root = 1.0 / 0.03 * DopplerMatrix::Identity();
    equations.measured = equations.root * state;
    for (int i = 0; i < kDopplerStates; ++i) {
      equations.measured[i] += normal_(random_);
    }
    const std::int64_t stamp_us = kBeginUs + us + (us < 50'000'000 ? 0 : pause_us_);
    velocities_.push_back({radar, stamp_us, equations});
    const double late_w = Vehicle::w_radps(t_s + truth[kPositionLead]);
    yaw_rates_.push_back({radar, kTurn, stamp_us, late_w + 0.02 * normal_(random_), 0.02});
  }

  std::vector<CalibrationVector> truths_;
  std::int64_t pause_us_;
  double (*slip_)(double t_s);
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::vector<VelocityMeasurement> velocities_;
  std::vector<YawRateMeasurement> yaw_rates_;
};

const std::vector<CalibrationVector> kTruths = {{0.02, 3.4, 0.1, 0.0, 0.0, 0.0, 0.0, 0.04},
                                                {1.6, 2.4, 0.8, 0.1, 0.02, 0.0, 0.03, 0.02},
                                                {-3.0, -0.6, -0.5, -0.2, -0.01, 0.0, -0.01, -0.03}};

TEST_CASE("the fit finds every state of every radar, as well as it says") {
  const CalibrationVector error = {0.2, 0.3, -0.2, 0.1, 0.01, 0.0, -0.02, -0.02, 0.0, 0.0};
  double squares = 0.0;
  double worst = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    CalibrationFit fit = RadarMinute(kTruths, seed).fit(error);
    for (int round = 0; round < 4; ++round) {
      fit.solve();  // Time offsets need the fitted motion.
    }
    for (std::size_t radar = 0; radar < kTruths.size(); ++radar) {
      const FittedRadar& found = fit.radars()[radar];
      for (const CalibrationState state : {kYaw, kX, kY, kOffset, kStamp, kLead, kPositionLead}) {
        if (found.prior_std[state] == 0.0) {
          CHECK(found.value[state] == Approx(kTruths[radar][state]).margin(1e-5));
          continue;
        }
        const double z = (found.value[state] - kTruths[radar][state]) / found.std[state];
        CAPTURE(seed, radar, state, found.value[state], found.std[state]);
        CHECK(std::abs(z) < 4.5);
        CHECK(found.std[state] < 0.03);
        squares += z * z;
        worst = std::max(worst, std::abs(z));
        ++count;
      }
    }
  }
  CHECK(squares / count < 1.3);
  CHECK(squares / count > 0.7);
}

TEST_CASE("what is held stays, and the vehicle's motion comes out") {
  CalibrationFit fit = RadarMinute(kTruths, 1).fit({});
  fit.limit(1, kX, 0.0);
  fit.solve();
  CHECK(fit.radars()[1].value[kX] == Approx(2.4).margin(1e-6));
  const auto motion = fit.motion(0, kBeginUs + 30'000'000);
  REQUIRE(motion);
  CHECK(motion->x() == Approx(Vehicle::v_mps(30.0)).margin(0.05));
  CHECK(motion->y() == Approx(Vehicle::w_radps(30.0)).margin(0.03));
  CHECK_FALSE(fit.motion(0, kBeginUs - 10'000'000));
}

TEST_CASE("what is found is held against parts of the drive in which it was not found") {
  std::vector<ChangedStates> yaws(kTruths.size());
  for (ChangedStates& changed : yaws) {
    changed[kYaw] = true;
  }
  int refused = 0;
  constexpr int kDrives = 10;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    const RadarMinute drive(kTruths, seed);
    CalibrationFit right = drive.fit({});
    right.minimise();
    refused += check_held_out(right, yaws).is_better ? 0 : 1;

    CalibrationVector error{};
    error[kYaw] = 0.009;
    CalibrationFit wrong = drive.fit(error);  // Of all radars.
    wrong.minimise();
    const HeldOutCheck check = check_held_out(wrong, yaws);
    CAPTURE(seed, check.found, check.configured);
    CHECK(check.found < check.configured);
    CHECK(check.is_better);
    for (const bool is_better : check.is_radar_better) {
      CHECK(is_better);
    }
  }
  // Nothing is better than the truth but by chance.
  CHECK(refused >= kDrives - 2);
}

TEST_CASE("so is the slip of the rear axle, which may be all that is to be changed") {
  const std::vector<ChangedStates> none(kTruths.size());
  const auto check = [&](unsigned seed, double (*slip)(double t_s)) {
    CalibrationFit fit = RadarMinute(kTruths, seed, 0, slip).fit({}, 0.005);
    fit.minimise();
    return check_held_out(fit, none, 0.0);
  };
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const HeldOutCheck same = check(seed, [](double) { return 0.003; });
    CAPTURE(seed, same.found, same.configured);
    CHECK(same.found < same.configured);
    CHECK(same.is_better);
    CHECK(same.is_slip_better);
    // What three of the fifths have, the other two have not.
    const HeldOutCheck other =
        check(seed, [](double t_s) { return std::fmod(t_s, 24.0) < 12.0 ? 0.003 : -0.003; });
    CAPTURE(other.found, other.configured);
    CHECK_FALSE(other.is_better);
    CHECK_FALSE(other.is_slip_better);
  }
}

TEST_CASE("a part of a drive has the measurements of its time") {
  CalibrationFit fit = RadarMinute(kTruths, 1).fit({});
  fit.minimise();
  const CalibrationFit second = fit.part(1, 5, true);
  CHECK(second.motion(0, kBeginUs + 18'000'000));
  CHECK_FALSE(second.motion(0, kBeginUs + 6'000'000));
  CHECK_FALSE(second.motion(0, kBeginUs + 30'000'000));
  const CalibrationFit others = fit.part(1, 5, false);
  CHECK_FALSE(others.motion(0, kBeginUs + 18'000'000));
  CHECK(others.motion(0, kBeginUs + 30'000'000));
  // Together they have all.
  const std::vector<CalibrationVector>& truths = kTruths;
  CHECK(second.misfit(truths) + others.misfit(truths) ==
        Approx(fit.part(0, 1, true).misfit(truths)).epsilon(0.02));
}

}  // namespace
TEST_CASE("parts are of the time that was measured: a log of the next day is none by itself") {
  constexpr std::int64_t kDayUs = 86'400'000'000;
  const CalibrationFit fit = RadarMinute(kTruths, 1, kDayUs).fit({});
  const CalibrationFit continued = RadarMinute(kTruths, 1).fit({});
  for (std::size_t part = 0; part < kHeldOutParts; ++part) {
    const double expected = continued.part(part, kHeldOutParts, true).misfit(kTruths);
    CHECK(fit.part(part, kHeldOutParts, true).misfit(kTruths) == Approx(expected).epsilon(0.05));
  }
}

}  // namespace cremed
