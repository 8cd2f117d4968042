// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <limits>
#include <stdexcept>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "tools/eval/calibrate/least_squares.hpp"

namespace cremed {
namespace {

/// The gradient of the cost at the present values, from the Jacobian.
double remaining_gradient(const LeastSquares& squares) {
  const LeastSquares::Linearised at = squares.linearise();
  return (at.jacobian.transpose() * at.residuals).norm();
}

/// A point on a line at x, from the line (offset, slope) and a shift of all its points.
struct LineResidual {
  double x;
  double y;

  template <typename T>
  void operator()(const T* line, const T* shift, T* row) const {
    row[0] = line[0] + line[1] * x + shift[0] - y;
  }
};

/// The shift, and firmly by how much the slope is more: without their product in the information
/// the search does not arrive.
struct ShiftResidual {
  double y;

  template <typename T>
  void operator()(const T* shift, const T* line, T* row) const {
    row[0] = shift[0] - y;
    row[1] = 10.0 * (line[1] - shift[0] - 1.5);
  }
};

/// Rosenbrock's valley, with its minimum at (1, 1).
struct Valley {
  template <typename T>
  void operator()(const T* at, T* rows) const {
    rows[0] = 10.0 * (at[1] - at[0] * at[0]);
    rows[1] = 1.0 - at[0];
  }
};

struct Offset {
  double y;

  template <typename T>
  void operator()(const T* at, T* row) const {
    row[0] = at[0] - y;
  }
};

}  // namespace

TEST_CASE("least squares: unknowns that terms share, in any order, are solved together") {
  std::array<double, 2> line{};
  std::array<double, 1> shift{};
  LeastSquares squares;
  squares.add_unknowns(line);
  squares.add_unknowns(shift);
  // 1 + 2 x with a shift of 0.5, where each term agrees.
  for (const double x : {-1.0, 0.0, 2.0, 3.0}) {
    squares.add<1>(LineResidual{x, 1.5 + 2.0 * x}, Loss(), line, shift);
  }
  squares.add<2>(ShiftResidual{0.5}, Loss(), shift, line);
  SECTION("with derivatives as by differences") {
    const LeastSquares::Linearised zero = squares.linearise();
    for (double* unknown : {&line[0], &line[1], &shift[0]}) {
      const auto column = unknown == &shift[0] ? 2 : static_cast<int>(unknown - line.data());
      *unknown = 1.0;
      const Eigen::VectorXd change = squares.linearise().residuals - zero.residuals;
      *unknown = 0.0;
      CHECK((Eigen::VectorXd(zero.jacobian.col(column)) - change).norm() < 1e-12);
    }
  }
  SECTION("to the least sum of squares") {
    squares.solve();
    CHECK(remaining_gradient(squares) < 1e-3);
    CHECK(line[0] == Approx(1.0).margin(1e-3));
    CHECK(line[1] == Approx(2.0).margin(1e-3));
    CHECK(shift[0] == Approx(0.5).margin(1e-3));
  }
}

TEST_CASE("least squares: a curved valley is followed to its end") {
  std::array<double, 2> at{-1.2, 1.0};
  LeastSquares squares;
  squares.add_unknowns(at);
  squares.add<2>(Valley(), Loss(), at);
  squares.solve();
  CHECK(at[0] == Approx(1.0).margin(1e-3));
  CHECK(at[1] == Approx(1.0).margin(2e-3));
}

TEST_CASE("least squares: what is far off counts less, as its loss says") {
  const auto kind = GENERATE(Loss::Kind::huber, Loss::Kind::cauchy);
  const Loss loss{kind, 1.0};
  std::array<double, 1> at{};
  LeastSquares squares;
  squares.add_unknowns(at);
  for (const double y : {-0.1, 0.0, 0.1, 0.2, 100.0}) {
    squares.add<1>(Offset{y}, loss, at);
  }
  squares.solve();
  // Beyond its scale Huber's loss pulls by that, Cauchy's by 1 / 100.
  const double pull = kind == Loss::Kind::huber ? 1.0 : 0.01;
  CHECK(at[0] == Approx(0.05 + pull / 4.0).margin(0.01));
  CHECK(remaining_gradient(squares) < 0.02);
}

TEST_CASE("least squares: what is not finite has no solution") {
  std::array<double, 1> at{};
  LeastSquares squares;
  squares.add_unknowns(at);
  squares.add<1>(Offset{std::numeric_limits<double>::quiet_NaN()}, Loss(), at);
  CHECK_THROWS_AS(squares.solve(), std::runtime_error);
}

}  // namespace cremed
