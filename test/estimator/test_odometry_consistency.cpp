// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/position_measurement.hpp"
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
  explicit ModelDrive(std::uint64_t seed)
      : random_(seed), truth_(options_, mounts()), estimate_(options_, mounts()) {
    truth_.start();
    estimate_.start();
    for (int i = 0; i < truth_.gaussian.size(); ++i) {
      truth_.gaussian.set_mean(i, truth_.gaussian.std(i) * normal_(random_));
    }
    // Speeds at which a driving vehicle's errors count in full.
    truth_.gaussian.set_mean(kSpeed, 12.0);
    const Eigen::Vector2d start(12.0 + normal_(random_),
                                truth_.gaussian.mean(kYawRate) + 0.1 * normal_(random_));
    estimate_.start_motion(start, Eigen::Vector2d(1.0, 0.01).asDiagonal());
  }

  void step(int number) {
    constexpr double kDtS = 0.04;
    move(kDtS);
    const std::size_t radar = number % 2 == 0 ? 0 : 1;
    move_errors(radar, 2.0 * kDtS);
    measure_doppler(radar);
    measure_positions(radar, number / 2);
    if (number % 50 == 49) {
      truth_.renew_anchor();
      estimate_.renew_anchor();
    }
  }

  [[nodiscard]] const GaussianState& truth() const { return truth_.gaussian; }
  [[nodiscard]] const GaussianState& estimate() const { return estimate_.gaussian; }
  [[nodiscard]] double nis() const { return nis_ / measurements_; }
  [[nodiscard]] int measurements() const { return measurements_; }

 private:
  static std::vector<Pose2> mounts() { return {{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}}; }

  template <int Size>
  Eigen::Matrix<double, Size, 1> draw(const Eigen::Matrix<double, Size, Size>& covariance) {
    Eigen::Matrix<double, Size, 1> white;
    for (int i = 0; i < Size; ++i) {
      white(i) = normal_(random_);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> solver(covariance);
    return solver.eigenvectors() *
           solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseProduct(white);
  }

  static void advance(OdometryState& state, double dt_s) {
    state.advance_to(state.time_us() + std::llround(dt_s * 1e6));
  }

  /// The truth follows the model, with noise drawn from the process noise.
  void move(double dt_s) {
    const MotionStep step = moved(truth_.gaussian.mean().head<kMotionStates>(), dt_s, options_);
    const MotionStep::Vector next = step.state + draw<kMotionStates>(step.noise);
    draw_forgetting(kCommonOffset, [&](OdometryState& state) { advance(state, dt_s); });
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
    velocity.velocity_mps = draw<2>(of_truth.noise) - of_truth.residual;
    use(DopplerMeasurement{estimate_, radar, 0.0}.linearise(velocity));
  }

  void measure_positions(std::size_t radar, int scan) {
    const Eigen::Matrix3d scan_noise = Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal();
    const Eigen::Matrix2d pair_noise = Eigen::Vector2d(9e-4, 2e-6).asDiagonal();
    truth_.clone_scan(radar, 0.0, Eigen::Matrix3d::Zero());
    const Eigen::Vector3d pose = truth_.gaussian.mean().head<kPose>();
    const Eigen::Vector3d noise = draw<3>(turned_covariance(pose.z(), scan_noise));
    for (int i = 0; i < kPose; ++i) {
      truth_.gaussian.set_mean(truth_.scan(radar) + i, pose(i) + noise(i));
    }
    estimate_.clone_scan(radar, 0.0, scan_noise);
    for (std::size_t k = 0; k < kKeyframes && scan >= 20; ++k) {
      const LinearMeasurement of_truth =
          PositionMeasurement{truth_, radar, k}.linearise(Eigen::Vector3d::Zero());
      const Eigen::Vector2d measured = draw<2>(pair_noise) - of_truth.residual;
      LinearMeasurement measurement =
          PositionMeasurement{estimate_, radar, k}.linearise({0.0, measured.x(), measured.y()});
      measurement.noise = pair_noise;
      use(measurement);
    }
    if (scan % 5 == 0) {
      truth_.keep_scan(radar, static_cast<std::size_t>(scan / 5 % kKeyframes));
      estimate_.keep_scan(radar, static_cast<std::size_t>(scan / 5 % kKeyframes));
    }
  }

  void use(const LinearMeasurement& measurement) {
    nis_ += 0.5 * estimate_.gaussian.innovate(measurement);
    ++measurements_;
    estimate_.update();
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
  double nis_ = 0.0;
  int measurements_ = 0;
};

TEST_CASE("on its own model every state's covariance is and stays true") {
  constexpr int kRuns = 60;
  constexpr int kSteps = 330;
  Eigen::VectorXd squares;
  double pose_nees = 0.0;
  double nis = 0.0;
  int measurements = 0;
  for (int run = 0; run < kRuns; ++run) {
    ModelDrive drive(static_cast<std::uint64_t>(run) + 1);
    for (int i = 0; i < kSteps; ++i) {
      drive.step(i);
    }
    const Eigen::VectorXd error = drive.estimate().mean() - drive.truth().mean();
    const Eigen::MatrixXd& covariance = drive.estimate().covariance();
    REQUIRE(covariance == covariance.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, Eigen::EigenvaluesOnly);
    REQUIRE(solver.eigenvalues().minCoeff() > -1e-12);
    if (squares.size() == 0) {
      squares.setZero(error.size());
    }
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      squares(i) += covariance(i, i) > 0.0 ? error(i) * error(i) / covariance(i, i) : 1.0;
    }
    pose_nees += numeric::normalised_error(error.head<3>(), covariance.topLeftCorner<3, 3>(), 3);
    nis += drive.nis() * drive.measurements();
    measurements += drive.measurements();
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
  CHECK(nis / measurements ==
        Approx(1.0).margin(4.0 *
                           numeric::anees_deviation(static_cast<std::size_t>(measurements), 2)));
}

}  // namespace
}  // namespace cremed
