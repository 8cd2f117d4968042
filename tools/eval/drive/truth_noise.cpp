// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/truth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace cremed {
namespace {

RelativePoseStd between(const RelativePoseStd& a, const RelativePoseStd& b, double interval_s) {
  const double share = (interval_s - a.interval_s) / (b.interval_s - a.interval_s);
  return {std::lerp(a.x_m, b.x_m, share), std::lerp(a.y_m, b.y_m, share),
          std::lerp(a.yaw_rad, b.yaw_rad, share), interval_s};
}

RelativePoseStd at(const std::vector<RelativePoseStd>& stds, double interval_s) {
  const auto after = std::ranges::upper_bound(stds, interval_s, {}, &RelativePoseStd::interval_s);
  if (after == stds.begin()) {
    return stds.front();
  }
  return after == stds.end() ? stds.back() : between(*(after - 1), *after, interval_s);
}

}  // namespace

TruthNoise::TruthNoise(std::vector<RelativePoseStd> stds) : stds_(std::move(stds)) {
  std::ranges::stable_sort(stds_, {}, &RelativePoseStd::interval_s);
}

Eigen::Matrix3d TruthNoise::covariance(std::int64_t interval_us) const {
  if (stds_.empty()) {
    return Eigen::Matrix3d::Zero();
  }
  const RelativePoseStd std = at(stds_, std::abs(static_cast<double>(interval_us)) * 1e-6);
  return Eigen::Vector3d(std.x_m, std.y_m, std.yaw_rad).array().square().matrix().asDiagonal();
}

std::string TruthNoise::note() const {
  std::string note;
  for (const RelativePoseStd& std : stds_) {
    note += fmt::format("{}{:g}, {:g} m, {:g} rad", note.empty() ? "" : "; ", std.x_m, std.y_m,
                        std.yaw_rad);
    if (stds_.size() > 1) {
      note += fmt::format(" over {:g} s", std.interval_s);
    }
  }
  return note.empty() ? note : "truth's own std added to the covariance: " + note;
}

}  // namespace cremed
