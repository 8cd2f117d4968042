// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/convictions.hpp"
#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::kFront;
using simulation::kRearLeft;
using simulation::kRearRight;

const Pose2 kLeft{2.4, 0.8, 1.56};
const Pose2 kRight{2.4, -0.8, -1.56};
const std::vector<Pose2> kFive{kFront, kRearLeft, kRearRight, kLeft, kRight};

/// What radars measure of a drive in bends at 8 m/s, and what a fault makes of it.
class Comparison {
 public:
  struct Measured {
    Eigen::Vector2d velocity_mps;
    double yaw_rate_radps;
    double speed_by_positions_mps;
    double error_of_registration_radps = 0.0;  ///< Of the yaw rate with Doppler.
  };
  using Fault = std::function<void(std::size_t radar, Measured&)>;

  explicit Comparison(const std::vector<Pose2>& mounts)
      : mounts_(mounts),
        state_(OdometryOptions(), mounts),
        faults_(state_),
        delays_s_(mounts.size()),
        is_silent_(mounts.size()) {}

  /// Radars scan in turn, each every 75 ms.
  void drive(double duration_s, const Fault& fault = {}, bool has_positions = true) {
    for (const double until_s = time_s_ + duration_s; time_s_ < until_s;) {
      for (std::size_t i = 0; i < mounts_.size(); ++i) {
        time_s_ += 0.075 / static_cast<double>(mounts_.size());
        if (!is_silent_[i]) {
          scan(i, fault, has_positions);
        }
      }
    }
  }
  /// Faster, with this slip of the rear axle for each m/s^2 of lateral acceleration.
  void corner(double speed_mps, double yaw_rate_radps, double slip_per_acceleration) {
    speed_mps_ = speed_mps;
    yaw_rate_radps_ = yaw_rate_radps;
    slip_per_acceleration_ = slip_per_acceleration;
  }
  /// From now on.
  void brake(double by_mps2, double for_s) { brakings_.push_back({time_s_, for_s, by_mps2}); }
  void silence(std::size_t radar) { is_silent_[radar] = true; }
  void speak(std::size_t radar) { is_silent_[radar] = false; }
  /// Of the stamps of a radar.
  void delay(std::size_t radar, double by_s) { delays_s_[radar] = by_s; }
  void accuse(std::size_t radar) { faults_.accuse(radar, std::llround(time_s_ * 1e6)); }
  bool refutes_speed_doubt(std::size_t radar, std::optional<double> scale = {}) {
    return faults_.refutes_speed_doubt(radar, std::llround(time_s_ * 1e6), scale);
  }
  void lose(bool is_after_step = false) {
    faults_.require_positions(is_after_step ? std::optional(-8.0) : std::nullopt);
  }
  /// The state sees a skid begin, or begins anew.
  void begin_skid() { state_.add_skid(0.15); }
  void restart() {
    state_.restart(std::llround(time_s_ * 1e6));
    faults_.forget_skid();
  }
  [[nodiscard]] double time_s() const { return time_s_; }
  void set_clock(double by_s) {
    time_s_ += by_s;
    faults_.clear();
  }
  [[nodiscard]] const FaultHypotheses& faults() const { return faults_; }
  [[nodiscard]] FaultHypotheses& faults() { return faults_; }

 private:
  struct Braking {
    double since_s;
    double for_s;
    double by_mps2;
  };

  [[nodiscard]] double speed_mps(double time_s) const {
    double result = speed_mps_ + std::sin(0.3 * time_s);
    for (const Braking& braking : brakings_) {
      result -= braking.by_mps2 * std::clamp(time_s - braking.since_s, 0.0, braking.for_s);
    }
    return std::max(0.0, result);
  }

  void scan(std::size_t radar, const Fault& fault, bool has_positions) {
    const auto stamp_us = static_cast<std::int64_t>(std::llround(time_s_ * 1e6));
    state_.hear(radar, stamp_us);
    const double time_s = time_s_ - delays_s_[radar];
    const double w = yaw_rate_radps_ * std::sin(0.5 * time_s);
    const double v = speed_mps(time_s);
    const Pose2& mount = mounts_[radar];
    const double across = w * mount.x_m - slip_per_acceleration_ * v * v * w;
    const double forward = v - w * mount.y_m;
    Measured measured{{forward + 0.03 * normal_(random_), across + 0.1 * normal_(random_)},
                      w + 0.01 * normal_(random_),
                      forward + 0.05 * normal_(random_)};
    if (fault) {
      fault(radar, measured);
    }
    EgoMotion motion;
    motion.status = MotionStatus::ok;
    motion.utime_start_us = stamp_us - 75'000;
    motion.utime_us = stamp_us;
    motion.motion.z() = 0.075 * (measured.yaw_rate_radps + measured.error_of_registration_radps);
    motion.covariance.setZero();
    motion.covariance(2, 2) = std::pow(0.075 * 0.01, 2);
    motion.by_positions = {0.075 * measured.yaw_rate_radps, motion.covariance(2, 2)};
    faults_.evidence.add_motion(radar, motion);
    DopplerVelocity velocity;
    velocity.velocity_mps = measured.velocity_mps;
    velocity.covariance = Eigen::Vector2d(0.001, 0.01).asDiagonal();
    faults_.add_velocity(radar, stamp_us, velocity);
    if (has_positions) {
      faults_.evidence.add_speed_by_positions(radar, stamp_us, measured.speed_by_positions_mps, 1.0,
                                              0.0);
    } else {
      faults_.evidence.add_too_few_targets(radar, stamp_us);
    }
  }

  std::vector<Pose2> mounts_;
  OdometryState state_;
  FaultHypotheses faults_;
  std::vector<double> delays_s_;
  std::vector<bool> is_silent_;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
  double time_s_ = 1000.0;
  std::vector<Braking> brakings_;
  double speed_mps_ = 8.0;
  double yaw_rate_radps_ = 0.2;
  double slip_per_acceleration_ = 0.0;
};

Comparison::Fault scaled(std::size_t guilty, double factor) {
  return [=](std::size_t radar, Comparison::Measured& measured) {
    measured.velocity_mps *= radar == guilty ? factor : 1.0;
  };
}

/// The mounts of these radars are turned by `yaw_rad`, so that what they see turns the other way.
/// The front radar's registration without sideways motion takes 0.4 of that for a turn.
Comparison::Fault turned(RadarSet guilty, double yaw_rad) {
  return [=](std::size_t radar, Comparison::Measured& measured) {
    if (contains(guilty, radar)) {
      const double forward_mps = measured.velocity_mps.x();
      measured.velocity_mps = Eigen::Rotation2Dd(-yaw_rad) * measured.velocity_mps;
      measured.error_of_registration_radps =
          radar == 0 ? -0.4 * yaw_rad * forward_mps / kFront.x_m : 0.0;
    }
  };
}

/// Its targets are turned to the other side, in Doppler and in positions.
Comparison::Fault turned_over(std::size_t guilty) {
  return [=](std::size_t radar, Comparison::Measured& measured) {
    if (radar == guilty) {
      measured.velocity_mps.y() *= -1.0;
      measured.yaw_rate_radps *= -1.0;
    }
  };
}

TEST_CASE("healthy radars are never at fault, and verified within a second") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront}, std::vector<Pose2>{kFront, kRearLeft},
                               kFive, std::vector<Pose2>{kLeft, kRight});
  const bool has_positions = GENERATE(true, false);
  Comparison comparison(mounts);
  comparison.drive(1.0, {}, has_positions);
  CHECK(comparison.faults().is_verified());
  for (int i = 0; i < 300; ++i) {
    comparison.drive(0.2, {}, has_positions);
    CHECK(comparison.faults().at_fault() == 0U);
    CHECK_FALSE(comparison.faults().is_unknown());
  }
}

TEST_CASE("the slip of the rear axle in fast bends is no radar's fault") {
  const Pose2 rear{-0.9, 0.0, 3.14};
  for (const std::vector<Pose2>& mounts :
       {std::vector<Pose2>{kFront, rear}, {kFront, kRearLeft, kRearRight}}) {
    Comparison comparison(mounts);
    comparison.corner(17.0, 0.4, 0.006);  // 7 m/s^2, twice the usual slip.
    for (int i = 0; i < 100; ++i) {
      comparison.drive(0.2, [](std::size_t radar, Comparison::Measured& measured) {
        const double mount_yaw_rad = radar == 0 ? -0.005 : 0.005;  // Of a healthy one.
        measured.velocity_mps.y() -= mount_yaw_rad * measured.velocity_mps.x();
      });
      REQUIRE(comparison.faults().at_fault() == 0);
      REQUIRE_FALSE(comparison.faults().is_unknown());
    }
  }
}

TEST_CASE("corner radars whose scales differ as their azimuths let them are healthy") {
  constexpr double kCorner = 0.785;
  Comparison comparison({{3.5, 0.8, kCorner},
                         {3.5, -0.8, -kCorner},
                         {-0.8, 0.8, 3.0 * kCorner},
                         {-0.8, -0.8, -3.0 * kCorner}});
  comparison.corner(30.0, 0.02, 0.003);
  for (int i = 0; i < 10; ++i) {
    comparison.drive(1.0, [](std::size_t radar, Comparison::Measured& measured) {
      measured.velocity_mps.x() *= radar == 0 ? 1.012 : 0.996;
    });
    CHECK(comparison.faults().at_fault() == 0U);
  }
}

TEST_CASE("the radar that differs from the others is at fault, and no other") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{2});
  const Comparison::Fault fault = GENERATE_REF(scaled(guilty, 0.9), scaled(guilty, 1.05),
                                               scaled(guilty, -1.0), turned_over(guilty));
  Comparison comparison(kFive);
  comparison.drive(5.0);
  comparison.drive(10.0, fault);
  CHECK(comparison.faults().at_fault() == 1U << guilty);
  CHECK_FALSE(comparison.faults().is_unknown());
}

TEST_CASE("one registration that went wrong convicts nobody, one a second later neither") {
  Comparison comparison(kFive);
  comparison.drive(3.0);
  for (int i = 0; i < 2; ++i) {
    comparison.drive(0.07, [](std::size_t radar, Comparison::Measured& measured) {
      measured.yaw_rate_radps += radar == 1 ? 0.5 : 0.0;
    });
    comparison.drive(1.2);
    CHECK(comparison.faults().at_fault() == 0);
  }
  // Those of a second do.
  comparison.drive(1.0, [](std::size_t radar, Comparison::Measured& measured) {
    measured.yaw_rate_radps += radar == 1 ? 0.5 : 0.0;
  });
  CHECK(comparison.faults().at_fault() == 0b10);
}

TEST_CASE("a single radar is outvoted by both that look sideways, not by one of them") {
  Comparison comparison({kFront, kLeft, kRight});
  comparison.drive(3.0);
  bool is_unknown = false;
  const auto drive_past = [&](bool on_both_sides) {
    for (int i = 0; i < 40; ++i) {
      comparison.drive(0.075, [=](std::size_t radar, Comparison::Measured& measured) {
        measured.velocity_mps.y() += radar == 1 || (radar == 2 && on_both_sides) ? 1.5 : 0.0;
      });
      is_unknown = is_unknown || comparison.faults().is_unknown();
    }
  };
  drive_past(false);
  CHECK_FALSE(is_unknown);
  CHECK(comparison.faults().at_fault() == 0U);
  drive_past(true);
  CHECK(is_unknown);
}

TEST_CASE("who brakes hard is not contradicted by the positions of the scan before") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront, kRearLeft}, kFive);
  Comparison comparison(mounts);
  comparison.drive(3.0);
  comparison.brake(8.7, 1.0);
  for (int i = 0; i < 40; ++i) {
    comparison.drive(0.05);
    CHECK(comparison.faults().at_fault() == 0U);
    CHECK_FALSE(comparison.faults().is_unknown());
  }
}

TEST_CASE("what a radar measured last is not continued into the time that it is silent") {
  const std::vector<Pose2> mounts{kFront, kRearLeft, kRearRight};
  const OdometryState state(OdometryOptions(), mounts);
  MotionEvidence evidence(state);
  DopplerVelocity velocity;
  velocity.velocity_mps = {8.0, 0.0};
  velocity.covariance = Eigen::Vector2d(0.001, 0.01).asDiagonal();
  constexpr int kSilentFrom = 30;
  int silent_epochs = 0;
  for (int scan = 0; scan < 40; ++scan) {
    const std::int64_t stamp_us = 1'000'000'000 + 75'000 * scan;
    if (scan < kSilentFrom) {
      evidence.add_velocity(0, stamp_us, velocity);
    }
    evidence.add_velocity(1, stamp_us + 10'000, velocity);
    evidence.add_velocity(2, stamp_us + 70'000, velocity);
    if (evidence.epochs() > 0 && evidence.time_us() > 1'000'000'000 + 75'000 * kSilentFrom) {
      ++silent_epochs;
      CHECK_FALSE(evidence.velocity(0));
      CHECK(evidence.velocity(1));
    }
  }
  CHECK(silent_epochs > 0);
}

TEST_CASE("three of seven with the same fault are found: most of the radars agree") {
  const std::vector<Pose2> seven{kFront,          kRearLeft,         kRearRight,
                                 {3.4, 0.6, 0.2}, {3.4, -0.6, -0.2}, {-0.8, 0.0, 3.1},
                                 {-0.8, 0.3, 3.0}};
  Comparison comparison(seven);
  comparison.drive(3.0);
  comparison.drive(5.0, [](std::size_t radar, Comparison::Measured& measured) {
    measured.velocity_mps *= radar < 3 ? 0.85 : 1.0;
  });
  CHECK(comparison.faults().at_fault() == 0b111);
  CHECK_FALSE(comparison.faults().is_unknown());
}

TEST_CASE("radars that look aside verify nothing while those that are judged are silent") {
  Comparison comparison({kFront, kLeft, kRight});
  comparison.drive(3.0);
  comparison.lose(true);
  comparison.silence(0);
  comparison.drive(3.0);
  CHECK_FALSE(comparison.faults().is_verified());
}

TEST_CASE("of two radars no cause is found again while the other is silent") {
  constexpr double kDelayS = 0.4;
  constexpr double kStepS = 0.15;
  Comparison both({kFront, kRearLeft});
  both.delay(0, kDelayS);
  int steps = 0;
  for (; both.faults().at_fault() == 0 && steps < 100; ++steps) {
    both.drive(kStepS);
  }
  REQUIRE(both.faults().at_fault() == 1U);
  // Half of the second for which the same delay has to be found.
  Comparison comparison({kFront, kRearLeft});
  comparison.delay(0, kDelayS);
  comparison.drive(kStepS * (steps - 4));
  REQUIRE(comparison.faults().at_fault() == 0);
  comparison.silence(1);
  comparison.drive(10.0);
  CHECK(comparison.faults().at_fault() == 0);
}

TEST_CASE("a radar that is late is at fault, with what corrects it, and no other") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  Comparison comparison(kFive);
  comparison.delay(guilty, 0.4);
  comparison.drive(15.0);
  CHECK(comparison.faults().at_fault() == 1U << guilty);
  const FaultCause cause = comparison.faults().cause(guilty);
  CHECK(cause.kind == FaultKind::late);
  CHECK(cause.value == Approx(0.4).margin(0.1));
}

TEST_CASE("of two radars the late one is at fault: none is early") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  Comparison comparison({kFront, kRearLeft});
  comparison.delay(guilty, 0.4);
  comparison.drive(25.0);
  CHECK(comparison.faults().at_fault() == 1U << guilty);
  CHECK(comparison.faults().cause(guilty).kind == FaultKind::late);
}

TEST_CASE("of two radars the one that is upside down is at fault, though both contradict") {
  const Pose2 rear = GENERATE(kRearLeft, kRearRight);
  Comparison comparison({kFront, rear});
  comparison.drive(20.0, turned_over(0));
  CHECK(comparison.faults().at_fault() == 1U);
  CHECK(comparison.faults().cause(0).kind == FaultKind::upside_down);
  CHECK_FALSE(comparison.faults().is_unknown());
}

TEST_CASE("which of two radars on one axis is upside down is not known") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  Comparison comparison({{3.4, 0.0, 0.0}, {-1.0, 0.0, 3.1416}});
  comparison.drive(20.0, turned_over(guilty));
  CHECK(comparison.faults().at_fault() == 0);
  CHECK(comparison.faults().is_unknown());
}

TEST_CASE("two rear radars that are turned alike are not exchanged, each other's mounts are") {
  // As of the nuScenes car: one that is turned by twice this fits the mount of the other.
  constexpr double kAxisRad = 0.09;
  const Pose2 left{-0.6, 0.63, std::numbers::pi - kAxisRad};
  const Pose2 right{-0.6, -0.63, -std::numbers::pi + kAxisRad};
  const double yaw_rad = GENERATE(-0.17, 0.17);
  Comparison comparison({kFront, left, right, kLeft, kRight});
  comparison.drive(5.0, turned(0b00110, yaw_rad));
  REQUIRE(comparison.faults().at_fault() == 0b00110U);
  // The one that fits the other's mount may as well be upside down.
  const std::size_t clear = yaw_rad > 0.0 ? 2 : 1;
  CHECK(comparison.faults().cause(clear).kind == FaultKind::mount_yaw);
  CHECK(comparison.faults().cause(clear).value == Approx(yaw_rad).margin(0.03));
  CHECK(comparison.faults().cause(3 - clear).kind == FaultKind::unknown);
  Comparison swapped({kFront, left, right, kLeft, kRight});
  swapped.drive(5.0, [&](std::size_t radar, Comparison::Measured& measured) {
    turned(0b00010, 2.0 * kAxisRad)(radar, measured);
    turned(0b00100, -2.0 * kAxisRad)(radar, measured);
  });
  REQUIRE(swapped.faults().at_fault() == 0b00110U);
  for (const std::size_t i : {1, 2}) {
    CHECK(swapped.faults().cause(i).kind == FaultKind::exchanged);
  }
}

TEST_CASE("two radars that look aside with each other's mounts are at fault") {
  Comparison comparison(kFive);
  comparison.drive(5.0, [](std::size_t radar, Comparison::Measured& measured) {
    measured.velocity_mps *= radar >= 3 ? -1.0 : 1.0;
  });
  CHECK(comparison.faults().at_fault() == 0b11000U);
  CHECK(comparison.faults().cause(3).kind == FaultKind::exchanged);
}

TEST_CASE("two radars with each other's mounts are at fault, confirmed by those that look aside") {
  Comparison comparison(kFive);
  comparison.drive(10.0, [](std::size_t radar, Comparison::Measured& measured) {
    const double turn_rad = radar == 1 ? 0.18 : radar == 2 ? -0.18 : 0.0;
    measured.velocity_mps = {std::cos(turn_rad) * measured.velocity_mps.x() -
                                 std::sin(turn_rad) * measured.velocity_mps.y(),
                             std::sin(turn_rad) * measured.velocity_mps.x() +
                                 std::cos(turn_rad) * measured.velocity_mps.y()};
  });
  CHECK(comparison.faults().at_fault() == 0b110U);
}

/// One ahead and one behind have each other's mount: to both the vehicle drives backwards. So it
/// does to all of `guilty`.
Comparison::Fault backwards(std::uint32_t guilty) {
  return [=](std::size_t radar, Comparison::Measured& measured) {
    const double sign = (guilty >> radar & 1U) != 0 ? -1.0 : 1.0;
    measured.velocity_mps.x() *= sign;
    measured.speed_by_positions_mps *= sign;
  };
}

TEST_CASE("two radars against one are at fault if those that look aside say so") {
  Comparison comparison(kFive);
  comparison.drive(10.0, backwards(0b011U));
  CHECK(comparison.faults().at_fault() == 0b011U);
  CHECK_FALSE(comparison.faults().is_unknown());
  CHECK_FALSE(comparison.faults().take_reversal());
  // With one against one they stay two against one.
  Comparison divided(kFive);
  divided.drive(10.0, backwards(0b01011U));
  CHECK(divided.faults().at_fault() != 0b011U);
}

TEST_CASE(
    "a radar is acquitted if those that convicted it are found wrong, and that is said once") {
  Comparison comparison(kFive);
  comparison.drive(3.0, backwards(0b11011U));
  REQUIRE(comparison.faults().at_fault() == 0b100U);
  CHECK_FALSE(comparison.faults().take_reversal());
  comparison.drive(2.0, backwards(0b00011U));
  CHECK(comparison.faults().at_fault() == 0b011U);
  CHECK(comparison.faults().take_reversal());
  CHECK_FALSE(comparison.faults().take_reversal());
}

TEST_CASE("a radar that found itself wrong is not acquitted by the others") {
  Comparison comparison(kFive);
  comparison.drive(3.0, backwards(0b11011U));
  comparison.accuse(2);
  comparison.drive(2.0, backwards(0b00011U));
  CHECK((comparison.faults().at_fault() & 0b100U) != 0);
  CHECK_FALSE(comparison.faults().take_reversal());
}

TEST_CASE("one radar that is right is acquitted once both others found themselves wrong") {
  const bool is_right = GENERATE(true, false);
  CAPTURE(is_right);
  Comparison comparison(kFive);
  const auto fault = [=](std::size_t radar, Comparison::Measured& measured) {
    if (radar == 1 || radar == 2) {  // Their maps follow their Doppler.
      measured.velocity_mps *= 0.8;
      measured.speed_by_positions_mps *= 0.8;
    } else if (radar == 0 && !is_right) {
      measured.speed_by_positions_mps *= 0.8;
    }
  };
  comparison.drive(2.0, fault);
  REQUIRE(comparison.faults().at_fault() == 0b001U);
  comparison.accuse(1);
  comparison.drive(0.3, fault);
  CHECK(comparison.faults().is_at_fault(0));  // The third has not.
  comparison.accuse(2);
  comparison.drive(0.3, fault);
  CHECK(comparison.faults().is_at_fault(0) == !is_right);
  CHECK(comparison.faults().is_at_fault(1));
  CHECK(comparison.faults().is_at_fault(2));
  CHECK(comparison.faults().take_reversal() == is_right);
  CHECK_FALSE(comparison.faults().take_reversal());
}

TEST_CASE("two of three radars that are late alike are at fault: the third cannot be early") {
  Comparison comparison(kFive);
  comparison.delay(1, 0.3);
  comparison.delay(2, 0.3);
  comparison.drive(8.0);
  comparison.brake(1.5, 3.0);
  bool is_reversed = false;
  for (int i = 0; i < 30 && !is_reversed; ++i) {
    comparison.drive(0.15);
    is_reversed = comparison.faults().take_reversal();
  }
  CHECK(is_reversed);
  CHECK(comparison.faults().at_fault() == 0b110U);
  comparison.drive(2.0);
  comparison.brake(1.5, 1.0);
  comparison.drive(2.0);
  CHECK(comparison.faults().at_fault() == 0b110U);
  for (const std::size_t late : {1U, 2U}) {
    CHECK(comparison.faults().cause(late).kind == FaultKind::late);
    CHECK(comparison.faults().cause(late).value == Approx(0.3).margin(0.06));
  }
}

TEST_CASE(
    "mounts that are all turned alike are told, and by how much; no radar is at fault alone") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront, kRearLeft},
                               std::vector<Pose2>{kFront, kRearLeft, kRearRight}, kFive);
  const double yaw_rad = GENERATE(-0.09, 0.06);
  Comparison comparison(mounts);
  comparison.drive(3.0, turned(0b11111, yaw_rad));
  CHECK(comparison.faults().at_fault() == 0U);
  CHECK(comparison.faults().is_unknown());
  CHECK_FALSE(comparison.faults().is_verified());
  for_each(comparison.faults().evidence.judged(), [&](std::size_t i) {
    CHECK(comparison.faults().cause(i).kind == FaultKind::mount_yaw);
    CHECK(comparison.faults().cause(i).value == Approx(yaw_rad).margin(0.015));
  });
  comparison.drive(3.0);
  CHECK_FALSE(comparison.faults().is_unknown());
  CHECK(comparison.faults().cause(0).kind == FaultKind::unknown);
}

TEST_CASE("in a skid no radar is at fault, and none is told apart from turned mounts at once") {
  Comparison comparison({kFront, kRearLeft, kRearRight});
  comparison.drive(3.0);
  comparison.begin_skid();
  SECTION("its slip changes") {
    for (int i = 0; i < 100; ++i) {
      comparison.drive(0.075, turned(0b111, 0.2 * std::sin(2.0 * comparison.time_s())));
      CHECK(comparison.faults().at_fault() == 0U);
      CHECK_FALSE(comparison.faults().is_unknown());
    }
    comparison.restart();
    comparison.drive(2.0);
    CHECK(comparison.faults().at_fault() == 0U);
    CHECK(comparison.faults().is_verified());
  }
  SECTION("it stays: the mounts are turned, and go on to be") {
    comparison.drive(3.0, turned(0b111, 0.08));
    CHECK_FALSE(comparison.faults().is_unknown());
    comparison.drive(4.0, turned(0b111, 0.08));
    for (int i = 0; i < 100; ++i) {
      comparison.drive(0.1, turned(0b111, 0.08));
      CHECK(comparison.faults().is_unknown());
    }
    CHECK(comparison.faults().cause(0).value == Approx(0.08).margin(0.015));
  }
  SECTION("the odometry begins anew") {
    comparison.drive(1.0, turned(0b111, 0.08));
    comparison.restart();
    comparison.drive(3.0, turned(0b111, 0.08));
    CHECK(comparison.faults().is_unknown());
  }
}

TEST_CASE("two of three radars that are turned alike are at fault: no vehicle slips like that") {
  const RadarSet guilty = GENERATE(0b011U, 0b101U, 0b110U);
  const double yaw_rad = GENERATE(-0.09, 0.09);
  Comparison comparison({kFront, kRearLeft, kRearRight});
  comparison.drive(3.0);
  comparison.drive(2.0, turned(guilty, yaw_rad));
  CHECK(comparison.faults().at_fault() == guilty);
  CHECK_FALSE(comparison.faults().is_unknown());
}

TEST_CASE("two others with a radar's speed tell that its own check found it wrong by chance") {
  const auto scale = GENERATE(1.0, 0.95);
  const std::size_t radar = GENERATE(0U, 1U, 2U);
  Comparison comparison(kFive);
  CHECK_FALSE(comparison.refutes_speed_doubt(radar));  // Nobody is heard yet.
  comparison.drive(6.0);
  comparison.drive(1.0, scaled(radar, scale));
  CHECK(comparison.refutes_speed_doubt(radar) == (scale == 1.0));
}

TEST_CASE("one other tells nothing of a radar's own check, nor do those that look aside") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront, kRearLeft},
                               std::vector<Pose2>{kFront, kRearLeft, kLeft, kRight});
  Comparison comparison(mounts);
  comparison.drive(2.0);
  CHECK_FALSE(comparison.refutes_speed_doubt(0));
}

TEST_CASE("radars whose own checks find them wrong within five seconds do not excuse each other") {
  Comparison comparison(kFive);
  comparison.drive(2.0);
  CHECK(comparison.refutes_speed_doubt(0));
  comparison.drive(1.0);
  CHECK_FALSE(comparison.refutes_speed_doubt(1));
  comparison.drive(1.0);
  CHECK_FALSE(comparison.refutes_speed_doubt(0));
  comparison.drive(6.0);
  CHECK(comparison.refutes_speed_doubt(0));
}

TEST_CASE("with a radar found at fault the motion by the others is told, once") {
  Comparison comparison(kFive);
  comparison.drive(5.0);
  CHECK_FALSE(comparison.faults().take_correction());
  comparison.drive(2.0, scaled(0, 0.8));
  const auto believed = comparison.faults().take_correction();
  REQUIRE(believed);
  CHECK(believed->x() == Approx(8.8).margin(0.3));  // 8 m/s and a sine of 1 m/s.
  CHECK(std::abs(believed->y()) < 0.25);
  CHECK_FALSE(comparison.faults().take_correction());
}

TEST_CASE(
    "of two radars only positions tell which is at fault from the start; without them it is not "
    "known") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  const bool has_positions = GENERATE(true, false);
  Comparison comparison({kFront, kRearLeft});
  comparison.drive(3.0, scaled(guilty, 0.9), has_positions);
  if (has_positions) {
    CHECK(comparison.faults().at_fault() == 1U << guilty);
  } else {
    CHECK(comparison.faults().at_fault() == 0U);
    CHECK(comparison.faults().is_unknown());
  }
}

TEST_CASE("a scale of a few percent between two radars is in dispute once, then allowed for") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  Comparison comparison({kFront, kRearLeft});
  comparison.drive(5.0);
  CHECK_FALSE(comparison.faults().take_scale_in_dispute());
  comparison.drive(3.0, scaled(guilty, 0.96), false);
  CHECK_FALSE(comparison.faults().is_unknown());
  const auto scale = comparison.faults().take_scale_in_dispute();
  REQUIRE(scale);
  CHECK(*scale == Approx(0.04).margin(0.008));
  comparison.drive(10.0, scaled(guilty, 0.96), false);
  CHECK_FALSE(comparison.faults().take_scale_in_dispute());
  CHECK(comparison.faults().at_fault() == 0U);
  // With more than that it jumps.
  comparison.drive(3.0, scaled(guilty, 0.8), false);
  CHECK(comparison.faults().at_fault() == set_of(guilty));
}

TEST_CASE("what all radars share is refuted by their positions") {
  const double factor = GENERATE(-1.0, 0.0, 0.8);
  Comparison comparison(kFive);
  comparison.drive(5.0);
  comparison.drive(3.0, [=](std::size_t /*radar*/, Comparison::Measured& measured) {
    measured.velocity_mps *= factor;
  });
  CHECK(comparison.faults().is_unknown());
  comparison.drive(3.0);
  CHECK_FALSE(comparison.faults().is_unknown());
}

Comparison::Fault all_scaled(double scale) {
  return [=](std::size_t /*radar*/, Comparison::Measured& measured) {
    measured.velocity_mps *= scale;
  };
}

TEST_CASE("a Doppler scale that all radars share is told within a second, not of a lone radar") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront}, std::vector<Pose2>{kFront, kRearLeft},
                               std::vector<Pose2>{kFront, kRearLeft, kRearRight}, kFive);
  const double scale = GENERATE(0.9, 0.95, 1.05, 1.1);
  CAPTURE(mounts.size(), scale);
  Comparison comparison(mounts);
  comparison.drive(3.0);
  CHECK_FALSE(comparison.faults().common_scale());
  for (int i = 0; i < 10 && !comparison.faults().common_scale(); ++i) {
    comparison.drive(0.15, all_scaled(scale));
  }
  REQUIRE(comparison.faults().common_scale().has_value() == (mounts.size() > 1));
  if (mounts.size() > 1) {
    const double part = (comparison.faults().common_scale()->factor - 1.0) / (1.0 / scale - 1.0);
    CHECK(part > 0.25);  // Some of these epochs are of before.
    CHECK(part < 1.25);
    comparison.faults().note_scale_learned();
    CHECK(comparison.faults().at_fault() == 0);
    CHECK_FALSE(comparison.faults().common_scale());
  }
}

TEST_CASE("no scale is shared by healthy radars, creeping ones, or one that differs") {
  Comparison comparison(GENERATE(std::vector<Pose2>{kFront, kRearLeft}, kFive));
  Comparison::Fault fault;
  SECTION("healthy, in bends") { comparison.corner(12.0, 0.35, 0.003); }
  SECTION("braking") { comparison.brake(5.0, 2.0); }
  SECTION("creeping") {
    comparison.corner(2.0, 0.0, 0.0);
    fault = all_scaled(0.9);
  }
  SECTION("one") { fault = scaled(1, 0.93); }
  SECTION("opposite") {
    fault = [](std::size_t radar, Comparison::Measured& measured) {
      measured.velocity_mps *= radar == 0 ? 0.95 : 1.05;
    };
  }
  for (int i = 0; i < 30; ++i) {
    comparison.drive(0.15, fault);
    CHECK_FALSE(comparison.faults().common_scale());
  }
}

TEST_CASE("radars whose own checks tell the same scale share it, unless their motions differ") {
  const double yaw_rad = GENERATE(0.0, 0.3);
  constexpr double kScale = 0.9;
  Comparison comparison({kFront, kRearLeft, kRearRight});
  comparison.drive(3.0);
  for (int i = 0; i < 8; ++i) {
    // Too fast for their maps: no positions.
    comparison.drive(
        0.15,
        [&](std::size_t radar, Comparison::Measured& measured) {
          turned(0b110, yaw_rad)(radar, measured);
          measured.velocity_mps *= kScale;
        },
        false);
    for (const std::size_t radar : {1U, 2U}) {
      comparison.refutes_speed_doubt(radar, 1.0 / kScale);
      comparison.accuse(radar);
    }
  }
  CHECK_FALSE(comparison.faults().common_scale());  // The front radar has not told it.
  for (int i = 0; i < 3; ++i) {
    const bool is_shared = comparison.refutes_speed_doubt(0, 1.0 / kScale);
    CHECK(is_shared == (i > 0 && yaw_rad == 0.0));
    comparison.accuse(0);
  }
}

TEST_CASE("a radar at fault returns after some seconds of agreement, each time later") {
  Comparison comparison(kFive);
  comparison.drive(5.0);
  double last_s = 0.0;
  for (int time = 0; time < 3; ++time) {
    comparison.drive(3.0, scaled(0, 0.8));
    REQUIRE(comparison.faults().is_at_fault(0));
    double left_out_s = 0.0;
    for (; comparison.faults().is_at_fault(0) && left_out_s < 100.0; left_out_s += 0.5) {
      comparison.drive(0.5);
    }
    CHECK(left_out_s > 3.0);
    CHECK(left_out_s > last_s);
    last_s = left_out_s;
  }
  CHECK(last_s < 30.0);
}

TEST_CASE("an accusation of hours ago does not keep a radar out for longer") {
  constexpr std::size_t kRadar = 0;
  Convictions convictions(1);
  std::int64_t time_us = 0;
  const auto held_s = [&](double healthy_s) {
    time_us += std::llround(healthy_s * 1e6);
    convictions.accuse(kRadar, set_of(kRadar), time_us);
    double result = 0.0;
    for (; convictions.at_fault() != 0U; result += 0.1, time_us += 100'000) {
      convictions.release(time_us);
    }
    return result;
  };
  const double first_s = held_s(0.0);
  for (int time = 0; time < 6; ++time) {
    CHECK(held_s(10.0) > first_s);
  }
  const double longest_s = held_s(10.0);
  CHECK(longest_s > 60.0 * first_s);
  CHECK(held_s(1300.0) < 0.6 * longest_s);
  CHECK(held_s(24.0 * 3600.0) == Approx(first_s));
}

TEST_CASE("who is acquitted is not wrong by its own check either") {
  constexpr RadarSet kBoth = 3U;
  Convictions convictions(2);
  convictions.accuse(0, kBoth, 0);
  convictions.accuse(1, kBoth, 0);
  convictions.acquit(set_of(0));
  CHECK(convictions.at_fault() == set_of(1));
  CHECK(convictions.accused() == set_of(1));
}

TEST_CASE("the only radar that is heard returns as soon, whatever others are silent") {
  const auto held_s = [](const std::vector<std::size_t>& silent) {
    Comparison comparison(kFive);
    for (const std::size_t radar : silent) {
      comparison.silence(radar);
    }
    comparison.drive(5.0);
    comparison.accuse(0);
    double result = 0.0;
    for (; comparison.faults().is_at_fault(0) && result < 20.0; result += 0.15) {
      comparison.drive(0.15);
    }
    return result;
  };
  CHECK(held_s({1, 2, 3, 4}) < 1.0);
  CHECK(held_s({1}) > 3.0);  // Of the two others one is right, perhaps.
  CHECK(held_s({}) > 3.0);
}

TEST_CASE(
    "radars that accuse themselves return soon after that if they are most, each time later") {
  Comparison comparison(kFive);
  comparison.drive(5.0);
  double last_s = 0.0;
  for (int time = 0; time < 4; ++time) {
    for (int i = 0; i < 20; ++i) {
      for (const std::size_t radar : {0U, 1U, 2U}) {
        comparison.accuse(radar);
      }
      comparison.drive(0.15);
      CHECK(comparison.faults().at_fault() == 7U);
    }
    double left_out_s = 0.0;
    for (; comparison.faults().is_at_fault(0) && left_out_s < 10.0; left_out_s += 0.15) {
      comparison.drive(0.15);
    }
    CHECK(left_out_s > last_s);
    last_s = left_out_s;
  }
  CHECK(last_s == Approx(4.0).margin(0.5));
  Comparison single(kFive);
  single.drive(5.0);
  single.accuse(0);
  single.drive(4.5);
  CHECK(single.faults().at_fault() == 1U);
  single.drive(1.0);
  CHECK(single.faults().at_fault() == 0U);
}

TEST_CASE("radars that found themselves wrong alike do not convict one that is right again") {
  Comparison comparison(kFive);
  comparison.drive(5.0);
  const auto accuse = [&](double duration_s, std::size_t from_radar) {
    for (double time_s = 0.0; time_s < duration_s; time_s += 0.15) {
      for (std::size_t radar = from_radar; radar < 3; ++radar) {
        comparison.accuse(radar);
      }
      comparison.drive(0.15, [=](std::size_t radar, Comparison::Measured& measured) {
        const double factor = from_radar <= radar && radar < 3 ? 0.7 : 1.0;
        measured.velocity_mps *= factor;
        measured.speed_by_positions_mps *= factor;
      });
    }
  };
  accuse(3.0, 0);
  REQUIRE(comparison.faults().at_fault() == 0b111U);
  accuse(1.5, 1);
  CHECK(comparison.faults().at_fault() == 0b110U);
}

TEST_CASE("a clock that is set holds no radar longer, and judging goes on") {
  const double by_s = GENERATE(-500.0, -1.0, 500.0);
  CAPTURE(by_s);
  Comparison comparison(kFive);
  comparison.drive(5.0);
  comparison.drive(3.0, scaled(0, 0.8));
  REQUIRE(comparison.faults().at_fault() == 1U);
  comparison.set_clock(by_s);
  comparison.drive(1.0);
  CHECK(comparison.faults().at_fault() == 1U);
  comparison.drive(10.0);
  CHECK(comparison.faults().at_fault() == 0U);
  comparison.drive(3.0, scaled(1, 0.8));
  CHECK(comparison.faults().at_fault() == 2U);
}

TEST_CASE("after the filter was lost only positions verify") {
  Comparison comparison(kFive);
  comparison.drive(5.0);
  REQUIRE(comparison.faults().is_verified());
  comparison.lose();
  CHECK_FALSE(comparison.faults().is_verified());
  comparison.drive(1.0);
  CHECK(comparison.faults().is_verified());
}

TEST_CASE("positions do not verify a rest that a radar's own check denies") {
  const bool is_accused = GENERATE(false, true);
  Comparison comparison({kFront, kRearLeft});
  comparison.drive(5.0);
  comparison.lose();
  for (int i = 0; i < 20; ++i) {
    comparison.drive(0.15, [](std::size_t /*radar*/, Comparison::Measured& measured) {
      measured = {Eigen::Vector2d::Zero(), 0.0, 0.0};
    });
    if (is_accused) {
      comparison.accuse(0);
    }
  }
  CHECK(comparison.faults().is_verified() == !is_accused);
}

TEST_CASE("after a step of all radars a rest is not verified, a step back is told once") {
  const bool is_step = GENERATE(false, true);
  const bool is_one_silent = GENERATE(false, true);
  Comparison comparison({kFront, kRearLeft, kRearRight});
  comparison.drive(5.0);
  if (is_one_silent) {
    comparison.silence(2);
  }
  const auto rest = [](std::size_t /*radar*/, Comparison::Measured& measured) {
    measured = {Eigen::Vector2d::Zero(), 0.0, 0.0};
  };
  comparison.drive(1.0, rest);
  comparison.lose(is_step);
  comparison.drive(30.0, rest);
  CHECK(comparison.faults().is_verified() == !is_step);
  CHECK_FALSE(comparison.faults().take_step_back());
  comparison.drive(0.15);
  CHECK(comparison.faults().take_step_back() == is_step);
  CHECK_FALSE(comparison.faults().take_step_back());
  comparison.drive(1.0);
  CHECK(comparison.faults().is_verified());
}

TEST_CASE("positions do not verify what agrees with a radar that is wrong by itself") {
  Comparison comparison({kFront, kRearLeft});
  comparison.drive(5.0);
  comparison.lose();
  // Of both the sign is wrong. In the positions of one chance agrees.
  comparison.drive(3.0, [](std::size_t radar, Comparison::Measured& measured) {
    measured.velocity_mps *= -1.0;
    measured.speed_by_positions_mps *= radar == 1 ? -1.0 : 1.0;
    measured.yaw_rate_radps *= radar == 1 ? -1.0 : 1.0;
  });
  CHECK_FALSE(comparison.faults().is_verified());
  comparison.drive(8.0);
  CHECK(comparison.faults().is_verified());
}

TEST_CASE("of two radars the one that jumps is wrong, not both if both do") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  CAPTURE(guilty);
  Comparison comparison({kFront, kRearLeft});
  comparison.drive(3.0);
  comparison.drive(0.4, scaled(guilty, 0.8));
  CHECK(comparison.faults().at_fault() == set_of(guilty));
  comparison.drive(2.0, scaled(guilty, 0.8));
  CHECK(comparison.faults().at_fault() == set_of(guilty));
  CHECK_FALSE(comparison.faults().is_unknown());
  comparison.drive(8.0);
  CHECK(comparison.faults().at_fault() == 0U);
  Comparison both({kFront, kRearLeft});
  both.drive(3.0);
  both.drive(0.4,
             [](std::size_t, Comparison::Measured& measured) { measured.velocity_mps *= 0.8; });
  CHECK(both.faults().at_fault() == 0U);
}

TEST_CASE("a jolt of the vehicle convicts none of the radars that show it") {
  const double jolt_mps = GENERATE(0.8, 1.0, 1.5);
  const bool misses_scans = GENERATE(false, true);
  CAPTURE(jolt_mps, misses_scans);
  const auto jolted = [=](std::size_t, Comparison::Measured& measured) {
    measured.velocity_mps.x() -= jolt_mps;
    measured.speed_by_positions_mps -= jolt_mps;
  };
  for (int phase = 0; phase < 20; ++phase) {
    Comparison comparison({kFront, kRearLeft, kRearRight});
    comparison.drive(3.0 + 0.075 * phase);
    if (misses_scans) comparison.silence(2);
    comparison.drive(0.15);
    comparison.speak(2);
    comparison.drive(0.6, jolted);
    CHECK(comparison.faults().at_fault() == 0U);
  }
}

}  // namespace
}  // namespace cremed
