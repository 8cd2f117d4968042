// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/laboratory/pairs/registration_pairs.hpp"

namespace cremed {

/// Bhattacharyya distance of two normal distributions: 1/8 d' S^-1 d + 1/2 log(det S / sqrt(det A
/// det B)) with d the difference of their means and S = (A + B) / 2.
double bhattacharyya_distance(const Eigen::Vector2d& difference, const Eigen::Matrix2d& a,
                              const Eigen::Matrix2d& b);

/// Overlap of the current scan of a pair, moved by the true motion, with the previous one.
struct CorrespondenceCounts {
  std::size_t correspondences = 0;  ///< Targets within distance 1 of some previous target.
  std::size_t outliers = 0;         ///< All others.
};

CorrespondenceCounts count_correspondences(const RegistrationPair& pair);

/// One line per pair: `pair,correspondences,outliers`. Throws std::runtime_error.
void write_correspondences_csv(const std::string& path, const std::vector<RegistrationPair>& pairs);

}  // namespace cremed
