// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/map/map_registration.hpp"
#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"
#include "test/estimator/numeric.hpp"

// Consistency of the filter's covariances on data drawn from its own model.

namespace cremed {
namespace {

using namespace state_layout;

/// A vehicle with two radars, drawn from the model, and its estimated state.
class ModelDrive {
 public:
  ModelDrive(std::uint64_t seed, double yaw_rate_radps)
      : random_(seed), truth_(options_, mounts()), estimate_(options_, mounts()) {
    truth_.start();
    estimate_.start();
    for (int i = 0; i < truth_.gaussian.size(); ++i) {
      truth_.gaussian.set_mean(i,
                               truth_.gaussian.mean(i) + truth_.gaussian.std(i) * normal_(random_));
    }
    // Speeds at which a driving vehicle's errors count in full.
    truth_.gaussian.set_mean(kSpeed, 12.0);
    truth_.gaussian.set_mean(kYawRate, yaw_rate_radps);
    const Eigen::Vector2d start(12.0 + normal_(random_), yaw_rate_radps + 0.1 * normal_(random_));
    estimate_.start_motion(start, Eigen::Vector2d(1.0, 0.01).asDiagonal());
  }

  void step(int number) {
    constexpr double kDtS = 0.04;
    move(kDtS);
    const std::size_t radar = number % 2 == 0 ? 0 : 1;
    move_errors(radar, 2.0 * kDtS);
    measure_doppler(radar);
    measure_positions(radar, number);
    if (number % 50 == 49) {
      truth_.renew_anchor();
      estimate_.renew_anchor();
    }
  }

  [[nodiscard]] const GaussianState& truth() const { return truth_.gaussian; }
  [[nodiscard]] const GaussianState& estimate() const { return estimate_.gaussian; }
  /// Sum over all measurements, and of how many numbers.
  [[nodiscard]] double nis() const { return nis_; }
  [[nodiscard]] int numbers() const { return numbers_; }

 private:
  /// Steps between nodes, and until each node has a pose.
  static constexpr int kNodePeriod = 6;
  static constexpr int kFirstMatch = kNodePeriod * static_cast<int>(kNodes);

  static std::vector<Pose2> mounts() { return {{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}}; }

  template <int Size>
  Eigen::Matrix<double, Size, 1> draw(const Eigen::Matrix<double, Size, Size>& covariance) {
    Eigen::Matrix<double, Size, 1> white;
    for (int i = 0; i < Size; ++i) {
      white(i) = normal_(random_);
    }
    return numeric::coloured(white, covariance);
  }

  static void advance(OdometryState& state, double dt_s) {
    state.advance_to(state.time_us() + std::llround(dt_s * 1e6));
  }

  /// The truth follows the model, with noise drawn from the process noise.
  void move(double dt_s) {
    const MotionStep step = moved(truth_.gaussian.mean().head<kMotionStates>(), dt_s, options_);
    const MotionStep::Vector next = step.state + draw<kMotionStates>(step.noise);
    draw_forgetting(kRounding, [&](OdometryState& state) { advance(state, dt_s); });
    for (int i = 0; i < kMotionStates; ++i) {
      truth_.gaussian.set_mean(i, next(i));
    }
    advance(estimate_, dt_s);
  }

  void move_errors(std::size_t radar, double dt_s) {
    for (int i = 0; i < kErrorStates; ++i) {
      truth_.gaussian.set(truth_.error(radar, i), truth_.gaussian.mean(truth_.error(radar, i)),
                          0.0);
    }
    truth_.advance_errors(radar, dt_s);
    for (int i = 0; i < kErrorStates; ++i) {
      const int which = truth_.error(radar, i);
      truth_.gaussian.set_mean(
          which, truth_.gaussian.mean(which) + truth_.gaussian.std(which) * normal_(random_));
    }
    estimate_.advance_errors(radar, dt_s);
  }

  template <typename Advance>
  void draw_forgetting(int which, const Advance& advance) {
    truth_.gaussian.set(which, truth_.gaussian.mean(which), 0.0);
    advance(truth_);
    truth_.gaussian.set_mean(
        which, truth_.gaussian.mean(which) + truth_.gaussian.std(which) * normal_(random_));
  }

  void measure_doppler(std::size_t radar) {
    DopplerVelocity velocity;
    velocity.covariance << 4e-4, 1e-4, 1e-4, 25e-4;
    velocity.per_offset = {radar == 0 ? -1.1 : 1.1, 0.05};
    const LinearMeasurement of_truth = DopplerMeasurement{truth_, radar, 0.0}.linearise(velocity);
    velocity.velocity_mps =
        draw<2>(of_truth.noise.topLeftCorner<2, 2>()) - of_truth.residual.head<2>();
    use(DopplerMeasurement{estimate_, radar, 0.0}.linearise(velocity), false);
  }

  /// A scan against the maps at all nodes, which measure with random shares of the information.
  void measure_positions(std::size_t radar, int number) {
    if (number >= kFirstMatch) {
      MapMatch match = draw_match(radar);
      place(truth_, radar, *map_of_truth_);
      place(estimate_, radar, *map_);
      const MapMeasurement of_truth{truth_, *map_of_truth_, radar, 0.0};
      const LinearMeasurement errors = of_truth.linearise(match, true);
      match.correction = true_correction(match) + draw<3>(errors.noise) - errors.residual;
      use(MapMeasurement{estimate_, *map_, radar, 0.0}.linearise(match, true), true);
    }
    if (number % kNodePeriod == 0) {
      const auto node = static_cast<std::size_t>(number / kNodePeriod % kNodes);
      truth_.clone_node(node, 0.0);
      estimate_.clone_node(node, 0.0);
    }
  }

  MapMatch draw_match(std::size_t radar) {
    MapMatch match;
    match.covariance = Eigen::Vector3d(9e-4, 9e-4, 2e-6).asDiagonal();
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (Eigen::Matrix3d& by : match.by_node) {
      // Of targets ahead, each with as much information along x as across.
      by.setZero();
      for (int i = 0; i < 10; ++i) {
        const Eigen::Vector2d at((radar == 0 ? 25.0 : -25.0) + 10.0 * normal_(random_),
                                 10.0 * normal_(random_));
        Eigen::Matrix<double, 2, 3> moved;
        moved << 1.0, 0.0, -at.y(), 0.0, 1.0, at.x();
        by += moved.transpose() * moved;
      }
      sum += by;
    }
    for (Eigen::Matrix3d& by : match.by_node) {
      by = (sum.inverse() * by).eval();
    }
    match.by_azimuth_scale = {0.0, 0.2 * normal_(random_), 0.5 * truth_.gaussian.mean(kYawRate)};
    return match;
  }

  /// A target in the map of each node, so that the map knows the place of the radar there.
  static void place(const OdometryState& state, std::size_t radar, TargetMap& map) {
    TargetSet one;
    one.add(Target());
    for (std::size_t i = 0; i < kNodes; ++i) {
      map.insert(i, one, state.mount(radar), Eigen::Vector3d::Zero());
    }
    map.place(MapMeasurement{state, map, radar, 0.0}.now_from_node());
  }

  /// Of error-free positions: the motion in the frame of the predicted pose by which each node's
  /// targets are displaced, weighted by the shares. By design x has no effect on y and yaw, nor
  /// these on x.
  [[nodiscard]] Eigen::Vector3d true_correction(const MapMatch& match) const {
    const Eigen::Vector3d true_now = truth_.gaussian.mean().head<kPose>();
    const Eigen::Vector3d now = estimate_.gaussian.mean().head<kPose>();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kNodes; ++i) {
      const Eigen::Vector3d by_node =
          composed_pose(estimate_.node_pose(i), relative_pose(truth_.node_pose(i), true_now));
      const Eigen::Vector3d displaced = relative_pose(now, by_node);
      const Eigen::Matrix3d& share = match.by_node[i];
      sum.x() += share(0, 0) * displaced.x();
      sum.tail<2>() += share.bottomRightCorner<2, 2>() * displaced.tail<2>();
    }
    return sum;
  }

  void use(const LinearMeasurement& measurement, bool is_of_positions) {
    const Innovation innovation = estimate_.gaussian.innovate(measurement);
    nis_ += innovation.nis;
    numbers_ += is_of_positions ? 3 : 2;
    estimate_.update(innovation, is_of_positions);
  }

  static OdometryOptions options() {
    OdometryOptions options;
    options.acceleration = {0.5, 1.0};
    options.yaw_acceleration = {0.1, 0.5};
    return options;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  OdometryOptions options_ = options();
  OdometryState truth_;
  OdometryState estimate_;
  std::unique_ptr<TargetMap> map_of_truth_ = std::make_unique<TargetMap>();
  std::unique_ptr<TargetMap> map_ = std::make_unique<TargetMap>();
  double nis_ = 0.0;
  int numbers_ = 0;
};

TEST_CASE("on its own model every state's covariance is and stays true") {
  const double yaw_rate_radps = GENERATE(0.0, 0.3);
  CAPTURE(yaw_rate_radps);
  constexpr int kRuns = 60;
  constexpr int kSteps = 330;
  Eigen::VectorXd squares;
  double pose_nees = 0.0;
  double nis = 0.0;
  int numbers = 0;
  for (int run = 0; run < kRuns; ++run) {
    ModelDrive drive(static_cast<std::uint64_t>(run) + 1, yaw_rate_radps);
    for (int i = 0; i < kSteps; ++i) {
      drive.step(i);
    }
    const Eigen::VectorXd error = drive.estimate().mean() - drive.truth().mean();
    const Eigen::MatrixXd& covariance = drive.estimate().covariance();
    REQUIRE(covariance == covariance.transpose());
    REQUIRE(numeric::eigenvalues(covariance).minCoeff() > -1e-12);
    if (squares.size() == 0) {
      squares.setZero(error.size());
    }
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      squares(i) += covariance(i, i) > 0.0 ? error(i) * error(i) / covariance(i, i) : 1.0;
    }
    pose_nees += numeric::normalised_error(error.head<3>(), covariance.topLeftCorner<3, 3>(), 3);
    nis += drive.nis();
    numbers += drive.numbers();
  }
  // Of chi-square with kRuns degrees of freedom, over as many, 99.99 %: 1 +- 3.9 sigma and its
  // skew.
  const double sigma = numeric::anees_deviation(kRuns, 1);
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    CAPTURE(i);
    CHECK(squares(i) / kRuns > 1.0 - 3.3 * sigma);
    CHECK(squares(i) / kRuns < 1.0 + 4.7 * sigma);
  }
  CHECK(pose_nees / (3 * kRuns) == Approx(1.0).margin(4.0 * numeric::anees_deviation(kRuns, 3)));
  // Innovations of a consistent filter are independent of each other.
  CHECK(nis / numbers ==
        Approx(1.0).margin(4.0 * numeric::anees_deviation(static_cast<std::size_t>(numbers), 1)));
}

}  // namespace
}  // namespace cremed
