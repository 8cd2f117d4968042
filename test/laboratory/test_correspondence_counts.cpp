// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/laboratory/pairs/correspondence_counts.hpp"

using namespace cremed;

namespace {

Eigen::Matrix2d diagonal(double xx, double yy) { return Eigen::Vector2d(xx, yy).asDiagonal(); }

Detection detection(double range_m, double azimuth_rad) {
  Detection result;
  result.range_m = range_m;
  result.azimuth_rad = azimuth_rad;
  result.range_std_m = 0.1;
  result.azimuth_std_rad = 0.01;
  result.doppler_std_mps = 0.1;
  return result;
}

}  // namespace

TEST_CASE("Bhattacharyya distance of normal distributions") {
  struct Row {
    Eigen::Vector2d difference;
    Eigen::Matrix2d a;
    Eigen::Matrix2d b;
    double distance;
  };
  const auto row =
      GENERATE(Row{{0.0, 0.0}, diagonal(1.0, 2.0), diagonal(1.0, 2.0), 0.0},
               Row{{2.0, 0.0}, diagonal(1.0, 1.0), diagonal(1.0, 1.0), 0.5},  // 4 / 8
               Row{{0.0, 2.0}, diagonal(1.0, 4.0), diagonal(1.0, 4.0), 0.125},
               // Mean 2.5, det 6.25 over sqrt(1 * 16).
               Row{{0.0, 0.0}, diagonal(1.0, 1.0), diagonal(4.0, 4.0), 0.5 * std::log(6.25 / 4.0)},
               Row{{1.0, 0.0},
                   diagonal(1.0, 1.0),
                   diagonal(4.0, 4.0),
                   1.0 / 20.0 + 0.5 * std::log(6.25 / 4.0)});
  CHECK(bhattacharyya_distance(row.difference, row.a, row.b) == Approx(row.distance).margin(1e-12));
  CHECK(bhattacharyya_distance(-row.difference, row.b, row.a) ==
        Approx(row.distance).margin(1e-12));
}

TEST_CASE("A target corresponds if the true motion brings it near a previous one") {
  RegistrationPair pair;
  pair.truth = {0.5, 0.2, 0.1};
  pair.previous = {detection(10.0, 0.0), detection(20.0, 0.3)};
  // The first target seen from the new pose; one at the limit of distance; one without a partner.
  const double x_m = 10.0 - 0.5;
  const double y_m = -0.2;
  const double range_m = std::hypot(x_m, y_m);
  const double azimuth_rad = std::atan2(y_m, x_m) - 0.1;
  // Distance 1 at a difference of sqrt(8) sigma of 0.1 m.
  pair.current = {detection(range_m, azimuth_rad), detection(range_m + 0.27, azimuth_rad),
                  detection(range_m + 0.30, azimuth_rad), detection(15.0, -0.5)};
  const CorrespondenceCounts counts = count_correspondences(pair);
  CHECK(counts.correspondences == 2);
  CHECK(counts.outliers == 2);

  pair.truth.yaw_rad = 0.0;
  CHECK(count_correspondences(pair).correspondences == 0);
}
