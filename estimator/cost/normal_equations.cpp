// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/normal_equations.hpp"

#include <Eigen/Cholesky>

namespace cremed {
namespace {

template <int States>
std::optional<Eigen::Matrix<double, States, States>> invert(
    const Eigen::Matrix<double, States, States>& information) {
  const Eigen::LLT<Eigen::Matrix<double, States, States>> factor(information);
  if (factor.info() != Eigen::Success || !(factor.rcond() > kMinReciprocalCondition)) {
    return std::nullopt;
  }
  const Eigen::Matrix<double, States, States> inverse =
      factor.solve(Eigen::Matrix<double, States, States>::Identity());
  // Removes asymmetry by rounding, which strict checks of users would reject.
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace

void NormalEquations::add_point(const Symmetric2& m, const Eigen::Vector2d& v,
                                const Eigen::Vector2d& lever_m) {
  information += point_information(m, lever_m);
  gradient += along_states(v, lever_m);
}

std::optional<Eigen::Matrix3d> invert_information(const Eigen::Matrix3d& information,
                                                  int degrees_of_freedom) {
  if (degrees_of_freedom == 3) {
    return invert<3>(information);
  }
  Eigen::Matrix2d free;
  free << information(0, 0), information(0, 2), information(2, 0), information(2, 2);
  const auto inverse = invert<2>(free);
  if (!inverse) {
    return std::nullopt;
  }
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  result(0, 0) = (*inverse)(0, 0);
  result(0, 2) = (*inverse)(0, 1);
  result(2, 0) = (*inverse)(1, 0);
  result(2, 2) = (*inverse)(1, 1);
  return result;
}

}  // namespace cremed
