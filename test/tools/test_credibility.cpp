// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "tools/eval/credibility.hpp"

using cremed::Credibility;

namespace {

Eigen::Matrix3d correlated() {
  Eigen::Matrix3d covariance;
  covariance << 4e-4, 1e-5, 2e-5, 1e-5, 1e-4, -1e-5, 2e-5, -1e-5, 9e-6;
  return covariance;
}

/// Estimates whose errors have `scale` times the claimed standard deviation.
Credibility draw_estimates(int degrees_of_freedom, double scale, int count) {
  Eigen::Matrix3d covariance = correlated();
  if (degrees_of_freedom == 2) {
    covariance.row(1).setZero();
    covariance.col(1).setZero();
  }
  const Eigen::Matrix3d draw_from =
      degrees_of_freedom == 3 ? covariance
                              : Eigen::Matrix3d(covariance + 1e-18 * Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d root = draw_from.llt().matrixL();
  std::mt19937 generator(5);
  std::normal_distribution<double> gaussian;
  Credibility credibility(degrees_of_freedom);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d truth(0.5, 0.0, 0.1);
    const Eigen::Vector3d unit(gaussian(generator), gaussian(generator), gaussian(generator));
    credibility.add(truth + scale * root * unit, covariance, truth);
  }
  return credibility;
}

}  // namespace

TEST_CASE("Honest estimates have ANEES 1 and Gaussian coverage") {
  for (const int degrees_of_freedom : {2, 3}) {
    constexpr int kCount = 20000;
    const Credibility credibility = draw_estimates(degrees_of_freedom, 1.0, kCount);
    // ANEES is chi-square(n d) / (n d): standard deviation sqrt(2 / (n d)).
    const double sigma = std::sqrt(2.0 / (kCount * degrees_of_freedom));
    CHECK(credibility.anees() == Approx(1.0).margin(4.0 * sigma));
    for (const int axis : {0, 2}) {
      CHECK(credibility.coverage(axis, 1) == Approx(0.6827).margin(0.015));
      CHECK(credibility.coverage(axis, 2) == Approx(0.9545).margin(0.007));
      CHECK(credibility.coverage(axis, 3) == Approx(0.9973).margin(0.002));
    }
    CHECK(std::isnan(credibility.coverage(1, 1)) == (degrees_of_freedom == 2));
  }
}

TEST_CASE("Claims of half the true standard deviation are found out") {
  const Credibility credibility = draw_estimates(3, 2.0, 5000);
  CHECK(credibility.anees() == Approx(4.0).epsilon(0.05));
  CHECK(credibility.coverage(0, 2) == Approx(0.6827).margin(0.03));
}

TEST_CASE("RMSE counts x and y, also where y is not estimated; yaw is wrapped") {
  Credibility credibility(2);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance(0, 0) = covariance(2, 2) = 1.0;
  const double pi = std::numbers::pi;
  credibility.add({3.0, 0.0, pi - 0.01}, covariance, {0.0, 4.0, -pi + 0.01});
  CHECK(credibility.rmse_m() == Approx(5.0));
  CHECK(credibility.rmse_deg() == Approx(0.02 * 180.0 / pi));
  CHECK(credibility.anees() == Approx((9.0 + 0.0004) / 2.0));
}

TEST_CASE("Nothing added is not a number, never a perfect score") {
  const Credibility credibility(2);
  CHECK(std::isnan(credibility.anees()));
  CHECK(std::isnan(credibility.rmse_m()));
}
