// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <random>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/state/gaussian_state.hpp"

namespace cremed {
namespace {

constexpr int kStates = 10;
constexpr int kFault = 4;
const auto kFirst = Eigen::seqN(0, Eigen::fix<4>);

/// A filter that has been through all operations, each with random numbers of the seed, and of
/// whose measurements the first number errs by a fault.
class FaultyFilter {
 public:
  explicit FaultyFilter(double fault) : fault_(fault) {
    for (int i = 0; i < kStates; ++i) {
      state.set(i, uniform_(random_), 1.0);
    }
  }

  void step() {
    const Eigen::Matrix4d by_self = random_matrix<4, 4>();
    state.set_to(kFirst, Eigen::Vector4d(by_self * state.mean().head<4>()), kFirst, by_self,
                 Eigen::Matrix4d(0.1 * Eigen::Matrix4d::Identity()));
    measure();
    const Eigen::Matrix<double, 3, 4> of_pose = random_matrix<3, 4>();
    const auto clone = Eigen::seqN(4, Eigen::fix<3>);
    state.set_to(clone, Eigen::Vector3d(of_pose * state.mean().head<4>()), kFirst, of_pose);
    measure();
    state.set_to(Eigen::seqN(7, Eigen::fix<3>), Eigen::Vector3d(state.mean().segment<3>(4)), clone,
                 Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
    const Eigen::Matrix<double, 3, 6> of_both = random_matrix<3, 6>();
    const std::array both{0, 1, 2, 4, 5, 6};
    state.set_to(clone, Eigen::Vector3d(of_both * state.mean()(both)), both, of_both);
    state.decay(8, 0.9, 0.01);
    measure();
    state.assume(3, 0.5);
    measure();
    state.set(9, 0.3, 0.2);
  }

  GaussianState state{kStates, true};

 private:
  template <int Rows, int Columns>
  Eigen::Matrix<double, Rows, Columns> random_matrix() {
    return Eigen::Matrix<double, Rows, Columns>::NullaryExpr([&] { return uniform_(random_); });
  }

  void measure() {
    LinearMeasurement measurement;
    measurement.noise *= 0.5;
    const Eigen::Vector3d by_fault = random_matrix<3, 1>();
    measurement.by_faults.col(kFault) = by_fault;
    measurement.residual = random_matrix<3, 1>() + fault_ * by_fault;
    for (int i = 0; i < kStates; i += 2) {
      const Eigen::Vector3d column = random_matrix<3, 1>();
      measurement.depend_on(i, column);
      measurement.residual -= column * state.mean(i);
    }
    state.update(state.innovate(measurement), std::to_array<GaussianState::Considered>({{6, 1}}));
  }

  double fault_;
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

TEST_CASE("The derivative of the mean by a fault is how the fault changes it") {
  constexpr double kSize = 0.7;
  FaultyFilter sound(0.0);
  FaultyFilter faulty(kSize);
  for (int step = 0; step < 5; ++step) {
    sound.step();
    faulty.step();
    const Eigen::VectorXd change = faulty.state.mean() - sound.state.mean();
    CHECK(change.norm() > 0.1);
    CHECK((kSize * faulty.state.by_faults().col(kFault) - change).norm() < 1e-9);
    CHECK(faulty.state.by_faults().norm() == faulty.state.by_faults().col(kFault).norm());
  }
  faulty.state.correct_faults(3, {0.0, kSize, 0.0}, 1e-12 * Eigen::Matrix3d::Identity());
  CHECK((faulty.state.mean() - sound.state.mean()).norm() < 1e-9);
}

TEST_CASE("A state without faults has no derivative by them") {
  GaussianState state(kStates);
  state.set(0, 1.0, 1.0);
  LinearMeasurement measurement;
  measurement.depend_on(0, 1.0);
  state.update(state.innovate(measurement), {});
  CHECK(state.by_faults().cols() == 0);
}

/// Estimate of an offset of the measured velocity by the innovations, divided by its sigma, and the
/// corrected position likewise.
Eigen::Vector2d normalised_errors(double offset, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  constexpr double kDtS = 0.1;
  Eigen::Vector2d truth(0.0, normal(random));
  GaussianState state(2, true);
  state.set(0, 0.0, 1e-4);
  state.set(1, 0.0, 1.0);
  truth.x() += 0.01 * normal(random);
  const Eigen::Matrix2d step{{1.0, kDtS}, {0.0, 1.0}};
  double information = 0.0;
  double weighted = 0.0;
  for (int i = 0; i < 50; ++i) {
    truth = step * truth + Eigen::Vector2d(0.0, 0.05 * normal(random));
    const Eigen::Matrix2d noise = Eigen::Vector2d(0.0, 0.0025).asDiagonal();
    const auto both = Eigen::seqN(0, Eigen::fix<2>);
    state.set_to(both, Eigen::Vector2d(step * state.mean()), both, step, noise);
    LinearMeasurement measurement;
    measurement.residual = {truth.x() + 0.1 * normal(random) - state.mean(0),
                            truth.y() + offset + 0.02 * normal(random) - state.mean(1), 0.0};
    measurement.noise.diagonal() = Eigen::Vector3d(0.01, 0.0004, 1.0);
    measurement.depend_on(0, 1.0, 0.0);
    measurement.depend_on(1, 0.0, 1.0);
    measurement.by_faults(1, 0) = 1.0;
    const Innovation innovation = state.innovate(measurement);
    information += innovation.whitened_by_faults.col(0).squaredNorm();
    weighted += innovation.whitened_by_faults.col(0).dot(innovation.whitened);
    state.update(innovation, {});
  }
  const double found = weighted / information;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  covariance(0, 0) = 1.0 / information;
  state.correct_faults(0, {found, 0.0, 0.0}, covariance);
  return {(found - offset) * std::sqrt(information), (state.mean(0) - truth.x()) / state.std(0)};
}

TEST_CASE("The innovations tell a fault, and the corrected state is as uncertain as it says") {
  const double offset = GENERATE(0.0, 0.5);
  std::mt19937_64 random(5);
  Eigen::Vector2d nees = Eigen::Vector2d::Zero();
  constexpr int kDraws = 400;
  for (int i = 0; i < kDraws; ++i) {
    nees += normalised_errors(offset, random).cwiseAbs2() / kDraws;
  }
  CHECK(nees.x() == Approx(1.0).margin(0.2));
  CHECK(nees.y() == Approx(1.0).margin(0.2));
}

}  // namespace
}  // namespace cremed
