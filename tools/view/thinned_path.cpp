// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/thinned_path.hpp"

#include <cmath>

namespace cremed {

void ThinnedPath::add(const PathPoint& point) {
  const bool is_far = points_.empty() || std::hypot(point.x_m - points_.back().x_m,
                                                    point.y_m - points_.back().y_m) >= spacing_m_;
  if (!is_far) {
    return;
  }
  points_.push_back(point);
  if (points_.size() > kMostPoints) {
    drop_every_second();
  }
}

void ThinnedPath::clear() {
  points_.clear();
  spacing_m_ = kFirstSpacingM;
}

void ThinnedPath::drop_every_second() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); i += 2) {
    points_[kept++] = points_[i];
  }
  points_.resize(kept);
  spacing_m_ *= 2.0;
}

}  // namespace cremed
