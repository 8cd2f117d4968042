// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Symmetric 2x2 matrix.
struct Symmetric2 {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  /// v' M v of (x, y). Not of a Vector2d: made of two numbers in a hot loop it is stored one by one
  /// and loaded as a whole, for which the processor waits.
  [[nodiscard]] double quadratic(double x, double y) const {
    return x * (xx * x + xy * y) + y * (xy * x + yy * y);
  }
  [[nodiscard]] double determinant() const { return xx * yy - xy * xy; }
  [[nodiscard]] double trace() const { return xx + yy; }
  [[nodiscard]] Symmetric2 inverse() const {
    const double scale = 1.0 / determinant();
    return {yy * scale, -xy * scale, xx * scale};
  }
};

inline Symmetric2 operator+(const Symmetric2& a, const Symmetric2& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}

inline Symmetric2 operator*(double factor, const Symmetric2& m) {
  return {factor * m.xx, factor * m.xy, factor * m.yy};
}

inline Eigen::Vector2d operator*(const Symmetric2& m, const Eigen::Vector2d& v) {
  return {m.xx * v.x() + m.xy * v.y(), m.xy * v.x() + m.yy * v.y()};
}

}  // namespace cremed
