// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace cremed {

struct PathPoint {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// A path of any length in bounded memory: points at least a spacing apart; when there are too many
/// every second is dropped and the spacing doubled.
class ThinnedPath {
 public:
  static constexpr std::size_t kMostPoints = 2000;

  void add(const PathPoint& point);
  void clear();
  [[nodiscard]] const std::vector<PathPoint>& points() const { return points_; }

 private:
  void drop_every_second();

  static constexpr double kFirstSpacingM = 0.2;
  double spacing_m_ = kFirstSpacingM;
  std::vector<PathPoint> points_;
};

}  // namespace cremed
