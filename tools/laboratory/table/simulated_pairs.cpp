// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/simulated_pairs.hpp"

#include <cmath>
#include <numbers>

#include "cremed/estimator/scan/degrees.hpp"

namespace cremed {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kLandmarks = 20;
constexpr std::size_t kClusterExtras = 2;
constexpr double kClusterStdM = 0.1;
constexpr double kMaxStepM = 0.25;
constexpr double kMaxTurnRad = 15.0 * kRadPerDeg;
constexpr double kPeriodS = 0.2;

constexpr DetectionNoise kPsrNoise{0.2, 3.0 * kRadPerDeg, 0.3};
constexpr DetectionNoise kSimNoise{0.13, 0.0157, 0.3};
constexpr double kSimSpread = 55.0 * kRadPerDeg;
constexpr double kSimView = 40.0 * kRadPerDeg;

// By the enumerators' order.
constexpr std::array<SimulatedProblemSettings, 4> kSettings{{
    {"PSR", "psr", 3, 5.0, 15.0, kPi, 2.0 * kPi, kPsrNoise, 0, 100, 1000},
    {"PSR-C", "psr", 3, 5.0, 15.0, kPi, 2.0 * kPi, kPsrNoise, 8, 100, 1000},
    {"Sim", "sim", 2, 2.5, 37.5, kSimSpread, kSimView, kSimNoise, 0, 50, 500},
    {"Sim-C", "sim", 2, 2.5, 37.5, kSimSpread, kSimView, kSimNoise, 8, 50, 500},
}};

/// Index of the random stream; run 0 is for the landmarks.
std::uint64_t stream(SimulatedProblem problem, std::size_t set, std::size_t run) {
  return (static_cast<std::uint64_t>(problem) << 60U) | (static_cast<std::uint64_t>(set) << 32U) |
         static_cast<std::uint64_t>(run);
}

using Landmarks = std::vector<Eigen::Vector2d>;

Landmarks draw_landmarks(const SimulatedProblemSettings& problem, Random random) {
  Landmarks landmarks;
  for (std::size_t i = 0; i < kLandmarks; ++i) {
    const double range_m = random.uniform(problem.min_range_m, problem.max_range_m);
    const double azimuth_rad = random.uniform(-problem.half_spread_rad, problem.half_spread_rad);
    landmarks.emplace_back(range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad));
  }
  for (std::size_t i = 0; i < problem.clusters; ++i) {
    for (std::size_t extra = 0; extra < kClusterExtras; ++extra) {
      const double dx_m = kClusterStdM * random.normal();
      const double dy_m = kClusterStdM * random.normal();
      landmarks.emplace_back(landmarks[i] + Eigen::Vector2d(dx_m, dy_m));
    }
  }
  return landmarks;
}

Pose2 draw_motion(const SimulatedProblemSettings& problem, Random& random) {
  Pose2 motion;
  motion.x_m = random.uniform(-kMaxStepM, kMaxStepM);
  motion.y_m = problem.degrees_of_freedom == 3 ? random.uniform(-kMaxStepM, kMaxStepM) : 0.0;
  motion.yaw_rad = random.uniform(-kMaxTurnRad, kMaxTurnRad);
  return motion;
}

std::vector<Detection> observe_all(const SimulatedProblemSettings& problem,
                                   const Landmarks& landmarks, const Pose2& pose,
                                   const Eigen::Vector2d& velocity_mps, Random& random) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  std::vector<Detection> detections;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d offset = landmarks[i] - Eigen::Vector2d(pose.x_m, pose.y_m);
    const Eigen::Vector2d point_m(c * offset.x() + s * offset.y(),
                                  -s * offset.x() + c * offset.y());
    if (std::abs(std::atan2(point_m.y(), point_m.x())) <= problem.half_view_rad) {
      detections.push_back(observe(point_m, velocity_mps, problem.noise, random));
      detections.back().id = static_cast<std::uint16_t>(i);
    }
  }
  return detections;
}

}  // namespace

const SimulatedProblemSettings& settings(SimulatedProblem problem) {
  return kSettings[static_cast<std::size_t>(problem)];
}

Detection observe(const Eigen::Vector2d& point_m, const Eigen::Vector2d& velocity_mps,
                  const DetectionNoise& noise, Random& random) {
  const double azimuth_rad = std::atan2(point_m.y(), point_m.x());
  Detection detection;
  detection.range_std_m = noise.range_m;
  detection.azimuth_std_rad = noise.azimuth_rad;
  detection.doppler_std_mps = noise.doppler_mps;
  detection.range_m = point_m.norm() + noise.range_m * random.normal();
  detection.azimuth_rad = azimuth_rad + noise.azimuth_rad * random.normal();
  const Eigen::Vector2d line_of_sight(std::cos(azimuth_rad), std::sin(azimuth_rad));
  detection.doppler_mps = -velocity_mps.dot(line_of_sight) + noise.doppler_mps * random.normal();
  detection.validity = Validity::usable;
  return detection;
}

RegistrationPair simulated_pair(SimulatedProblem problem, std::uint64_t seed, std::size_t set,
                                std::size_t run) {
  const SimulatedProblemSettings& chosen = settings(problem);
  const Landmarks landmarks = draw_landmarks(chosen, Random(seed, stream(problem, set, 0)));
  Random random(seed, stream(problem, set, run + 1));
  RegistrationPair pair;
  pair.dt_s = kPeriodS;
  pair.truth = draw_motion(chosen, random);
  // As in the Doppler model: the direction of motion is in the current radar's frame.
  const Eigen::Vector2d velocity_mps = Eigen::Vector2d(pair.truth.x_m, pair.truth.y_m) / kPeriodS;
  pair.previous = observe_all(chosen, landmarks, Pose2{}, velocity_mps, random);
  pair.current = observe_all(chosen, landmarks, pair.truth, velocity_mps, random);
  return pair;
}

std::vector<RegistrationPair> simulated_pairs(SimulatedProblem problem, std::uint64_t seed,
                                              std::size_t sets, std::size_t runs) {
  std::vector<RegistrationPair> pairs;
  pairs.reserve(sets * runs);
  for (std::size_t set = 0; set < sets; ++set) {
    for (std::size_t run = 0; run < runs; ++run) {
      pairs.push_back(simulated_pair(problem, seed, set, run));
    }
  }
  return pairs;
}

}  // namespace cremed
