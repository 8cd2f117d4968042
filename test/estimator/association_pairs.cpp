// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/association_pairs.hpp"

#include <cmath>
#include <cstddef>

namespace cremed::simulation {

void fill(Association& association, const Ratios& ratios, const Gradients& gradients) {
  association.clear(static_cast<std::size_t>(ratios.cols()));
  for (Eigen::Index i = 0; i < ratios.rows(); ++i) {
    association.begin_row();
    for (Eigen::Index j = 0; j < ratios.cols(); ++j) {
      const auto k = static_cast<std::size_t>(i * ratios.cols() + j);
      if (ratios(i, j) != 0.0) {
        association.add(
            static_cast<std::size_t>(j), ratios(i, j),
            gradients.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : gradients[k]);
      }
    }
  }
}

Ratios random_ratios(Random& random, Eigen::Index rows, Eigen::Index columns, double decades) {
  return Ratios::NullaryExpr(rows, columns,
                             [&] { return std::pow(10.0, uniform(random, -decades, decades)); });
}

std::unique_ptr<Association> make_association() { return std::make_unique<Association>(); }

}  // namespace cremed::simulation
