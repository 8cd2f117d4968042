// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/free_states.hpp"

#include <Eigen/Cholesky>

namespace cremed {

const std::vector<Eigen::Index>& free_states(int degrees_of_freedom) {
  static const std::vector<Eigen::Index> kTwo{0, 2};
  static const std::vector<Eigen::Index> kThree{0, 1, 2};
  return degrees_of_freedom == 2 ? kTwo : kThree;
}

std::optional<Eigen::Matrix3d> invert_free(const Eigen::Matrix3d& information,
                                           int degrees_of_freedom) {
  const auto& states = free_states(degrees_of_freedom);
  const Eigen::MatrixXd block = information(states, states);
  const Eigen::LLT<Eigen::MatrixXd> factor(block);
  if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-14)) {
    return std::nullopt;
  }
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  const Eigen::MatrixXd block_inverse =
      factor.solve(Eigen::MatrixXd::Identity(block.rows(), block.cols()));
  inverse(states, states) = block_inverse;
  return inverse;
}

}  // namespace cremed
