// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// Radars that fall silent, come back, or lie.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "estimator/fused_estimator.hpp"
#include "test/estimator/drawn_vehicle.hpp"

namespace cremed {
namespace {

using simulation::drawn_options;
using simulation::drawn_radars;
using simulation::DrawnMotion;
using simulation::DrawnVehicle;
using simulation::seconds_since_start;

/// What becomes of a motion on its way: false if it does not arrive at all.
using Alter = std::function<bool(double time_s, DrawnMotion& drawn)>;

bool is_between(double time_s, double begin_s, double end_s) {
  return time_s >= begin_s && time_s < end_s;
}

/// A drive round bends, with everything that came out.
struct FusedDrive {
  FusedDrive(std::size_t radars, Alter alter_motion)
      : options(drawn_options(2)),
        vehicle(simulation::in_bends, drawn_radars(radars), options, 5),
        estimator({}, options, radars),
        alter(std::move(alter_motion)) {}

  void until(double time_s) {
    while (vehicle.time_s() < time_s) {
      DrawnMotion drawn = vehicle.next();
      if (!alter(vehicle.time_s(), drawn)) {
        continue;
      }
      if (const auto motion =
              estimator.update(drawn.radar, drawn.motion, drawn.radar != not_believed)) {
        fused.push_back(*motion);
      }
    }
  }
  /// Largest squared error, of each state in its own standard deviations, from a time on.
  [[nodiscard]] double worst(double begin_s) const {
    double result = 0.0;
    for (const EgoMotion& motion : fused) {
      if (motion.has_estimate() && seconds_since_start(motion.utime_us) > begin_s) {
        const Eigen::Vector3d error = motion.motion - vehicle.truth(motion);
        result = std::max(result,
                          error.cwiseAbs2().cwiseQuotient(motion.covariance.diagonal()).maxCoeff());
      }
    }
    return result;
  }
  [[nodiscard]] std::vector<EgoMotion> estimates() const {
    std::vector<EgoMotion> result;
    std::copy_if(fused.begin(), fused.end(), std::back_inserter(result),
                 [](const EgoMotion& motion) { return motion.has_estimate(); });
    return result;
  }
  [[nodiscard]] std::size_t count(MotionStatus status) const {
    return static_cast<std::size_t>(std::count_if(
        fused.begin(), fused.end(), [&](const EgoMotion& m) { return m.status == status; }));
  }
  [[nodiscard]] bool contradicts(std::size_t radar) const {
    return estimator.agreement(radar).contradicts;
  }

  EgoMotionOptions options;
  DrawnVehicle vehicle;
  FusedEstimator estimator;
  Alter alter;
  std::size_t not_believed = kMaxFusedRadars;  ///< None.
  std::vector<EgoMotion> fused;
};

constexpr double kSixSigma = 36.0;

/// How far estimates do not join.
std::size_t gaps(const std::vector<EgoMotion>& motions) {
  std::size_t result = 0;
  for (std::size_t i = 1; i < motions.size(); ++i) {
    result += motions[i].utime_start_us == motions[i - 1].utime_us ? 0 : 1;
  }
  return result;
}

TEST_CASE("fused: a radar that follows may drop out and come back") {
  FusedDrive drive(3, [](double time_s, DrawnMotion& drawn) {
    return drawn.radar != 1 || !is_between(time_s, 5.0, 8.0);
  });
  drive.until(5.0);
  const std::uint64_t before = drive.estimator.agreement(1).used;
  drive.until(8.0);
  CHECK(drive.estimator.agreement(1).used <= before + 1);
  drive.until(12.0);
  CHECK(drive.estimator.agreement(1).used > before + 50);
  CHECK(drive.count(MotionStatus::no_reference) == 1);
  CHECK(drive.estimates().size() == drive.fused.size() - 1);
  CHECK(gaps(drive.estimates()) == 0);
  CHECK(drive.worst(0.0) < kSixSigma);
}

TEST_CASE("fused: where the leading radar is silent the next one leads until it is back") {
  FusedDrive drive(3, [](double time_s, DrawnMotion& drawn) {
    return drawn.radar != 0 || !is_between(time_s, 5.0, 8.0);
  });
  drive.until(12.0);
  CHECK(gaps(drive.estimates()) == 0);
  CHECK(drive.worst(0.0) < kSixSigma);
  std::int64_t longest_us = 0;
  std::vector<std::size_t> of_radar(3);
  for (const EgoMotion& motion : drive.estimates()) {
    longest_us = std::max(longest_us, motion.utime_us - motion.utime_start_us);
    const double time_s = seconds_since_start(motion.utime_us);
    const std::int64_t since_us = motion.utime_us - simulation::kDrawnStartUs;
    const bool is_first = since_us % 75'000 == 0;
    const bool is_second = (since_us - 41'000) % 66'000 == 0;
    CHECK((is_first || (is_second && is_between(time_s, 5.0, 8.1)) || time_s < 5.4));
    of_radar[is_first ? 0 : 1] += 1;
  }
  CHECK(longest_us <= 250'000 + 110'000);
  CHECK(of_radar[0] > 100);
  CHECK(of_radar[1] > 35);
}

TEST_CASE("fused: silence of all is a gap, and ends with the next motion") {
  FusedDrive drive(2, [](double time_s, DrawnMotion& drawn) {
    if (is_between(time_s, 6.0, 6.2)) {  // What spans the silence is no estimate of theirs either.
      drawn.motion = {.utime_start_us = drawn.motion.utime_us,
                      .utime_us = drawn.motion.utime_us,
                      .status = MotionStatus::gap_too_long};
    }
    return !is_between(time_s, 5.0, 6.0);
  });
  drive.until(10.0);
  CHECK(drive.count(MotionStatus::gap_too_long) == 1);
  CHECK(gaps(drive.estimates()) == 1);
  CHECK(drive.estimates().size() >= 115);
  CHECK(drive.fused.back().has_estimate());
  CHECK(drive.worst(0.0) < kSixSigma);
}

TEST_CASE("fused: scans without any estimate are spanned, and say why") {
  FusedDrive drive(2, [](double time_s, DrawnMotion& drawn) {
    if (is_between(time_s, 5.0, 5.25)) {
      drawn.motion.status = MotionStatus::too_few_targets;
      drawn.motion.motion.setConstant(EgoMotion::kNothing);
      drawn.motion.covariance.setConstant(EgoMotion::kNothing);
    }
    return true;
  });
  drive.until(10.0);
  CHECK(drive.count(MotionStatus::too_few_targets) >= 2);
  for (const EgoMotion& motion : drive.fused) {
    CHECK(motion.has_estimate() == motion.motion.allFinite());
    CHECK(motion.has_estimate() == motion.covariance.allFinite());
  }
  CHECK(gaps(drive.estimates()) == 0);
  CHECK(drive.worst(0.0) < kSixSigma);
}

TEST_CASE("fused: with one of two radars without estimates the other one goes on") {
  FusedDrive drive(2, [](double, DrawnMotion& drawn) {
    if (drawn.radar == 0) {
      drawn.motion.status = MotionStatus::ambiguous;
    }
    return true;
  });
  drive.until(5.0);
  CHECK(drive.estimates().size() > 60);
  CHECK(drive.worst(0.0) < kSixSigma);
  CHECK(drive.estimator.agreement(0).used == 0);
}

/// Ten standard deviations in one state, or all the wrong way round.
struct Lie {
  std::string name;
  Eigen::Vector3d bias;
  bool is_reversed;
};

void tell(const Lie& lie, EgoMotion& motion) {
  if (!motion.has_estimate()) {
    return;
  }
  if (lie.is_reversed) {
    motion.motion = -motion.motion;
    motion.gradient = -motion.gradient;
  }
  motion.motion.x() += lie.bias.x();
  motion.motion.z() += lie.bias.z();
  motion.gradient -= motion.information.col(1) * lie.bias.y();
}

const std::vector<Lie> kLies = {{"x", {0.09, 0.0, 0.0}, false},
                                {"yaw", {0.0, 0.0, 0.04}, false},
                                {"reversed", {0.0, 0.0, 0.0}, true}};

TEST_CASE("fused: a radar that lies is left out until it is right again, whichever it is") {
  const Lie lie = GENERATE(from_range(kLies));
  const std::size_t radars = GENERATE(2U, 3U, 5U);
  const std::size_t liar = GENERATE(0U, 1U);
  CAPTURE(lie.name, radars, liar);
  FusedDrive drive(radars, [&](double time_s, DrawnMotion& drawn) {
    if (drawn.radar == liar && is_between(time_s, 20.0, 40.0)) {
      tell(lie, drawn.motion);
    }
    return true;
  });
  const auto check_only = [&](bool is_contradicted) {
    for (std::size_t radar = 0; radar < radars; ++radar) {
      CAPTURE(radar);
      CHECK(drive.contradicts(radar) == (is_contradicted && radar == liar));
    }
  };
  drive.until(20.0);
  check_only(false);
  drive.until(30.0);
  check_only(true);
  const std::uint64_t used = drive.estimator.agreement(liar).used;
  drive.until(40.0);
  CHECK(drive.estimator.agreement(liar).used == used);
  CHECK(drive.estimator.agreement(liar).left_out > 100);
  drive.until(101.0);
  check_only(false);
  CHECK(drive.estimator.agreement(liar).used > used);
  CHECK(drive.worst(0.0) < kSixSigma);
  CHECK(gaps(drive.estimates()) == 0);
}

TEST_CASE("fused: a y that is far from that of a car does no harm") {
  FusedDrive drive(2, [&](double time_s, DrawnMotion& drawn) {
    if (drawn.radar == 1 && time_s > 5.0) {
      tell({"y", {0.0, 0.25, 0.0}, false}, drawn.motion);
    }
    return true;
  });
  drive.until(30.0);
  CHECK(drive.worst(0.0) < kSixSigma);
  CHECK(gaps(drive.estimates()) == 0);
}

TEST_CASE("fused: radars that all contradict each other are believed again once they agree") {
  FusedDrive drive(2, [&](double time_s, DrawnMotion& drawn) {
    if (is_between(time_s, 20.0, 40.0)) {
      drawn.motion.motion.z() += drawn.radar == 0 ? 0.04 * std::sin(9.0 * time_s) : -0.04;
    }
    return true;
  });
  drive.until(160.0);
  CHECK_FALSE(drive.contradicts(0));
  CHECK_FALSE(drive.contradicts(1));
  CHECK(drive.fused.back().has_estimate());
}

TEST_CASE("fused: the last radar is used again a minute after all others fell silent") {
  FusedDrive drive(2, [&](double time_s, DrawnMotion& drawn) {
    if (drawn.radar == 1 && is_between(time_s, 20.0, 40.0)) {
      drawn.motion.motion.z() += 0.04;
    }
    return drawn.radar == 1 || time_s < 40.0;
  });
  drive.until(40.0);
  CHECK(drive.contradicts(1));
  drive.until(110.0);
  CHECK_FALSE(drive.contradicts(1));
  CHECK(drive.fused.back().has_estimate());
}

TEST_CASE("fused: a radar that is not believed is compared, not used") {
  FusedDrive drive(3, [](double, DrawnMotion& drawn) {
    drawn.motion.motion.z() += drawn.radar == 2 && drawn.motion.has_estimate() ? 0.04 : 0.0;
    return true;
  });
  drive.not_believed = 2;
  drive.until(20.0);
  CHECK(drive.estimator.agreement(2).used == 0);
  CHECK(drive.estimator.agreement(2).innovation.mean() > 10.0);
  CHECK(drive.contradicts(2));
  CHECK(drive.estimator.agreement(0).innovation.mean() < 2.0);
  CHECK(drive.estimator.agreement(0).left_out <= 2);
  CHECK(drive.worst(0.0) < kSixSigma);
}

}  // namespace
}  // namespace cremed
