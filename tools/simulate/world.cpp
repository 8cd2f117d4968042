// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace cremed {
namespace {

constexpr double kMarginM = 120.0;       ///< Length of the world before and after the road.
constexpr double kClearanceM = 3.0;      ///< Free space on both sides of the path of the rear axle.
constexpr double kLeftLanesM = 6.0;      ///< More free space on the left, for the traffic there.
constexpr double kClutterReachM = 80.0;  ///< To both sides, so that turns have targets too.
constexpr double kRoadSpacingM = 1.0;
constexpr double kCellM = 25.0;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// A tunnel's wall reflects at a few of many places, at others in each scan.
constexpr double kTunnelSpacingM = 0.25;
constexpr double kTunnelOffsetM = 1.5;
constexpr double kTunnelProbability = 0.03;

/// A stretch of one side of the road of one kind.
struct BlockKind {
  double least_length_m;
  double greatest_length_m;
  double least_offset_m;  ///< From the edge of the free space.
  double greatest_offset_m;
  double spacing_m;  ///< Of the reflectors along the road.
  double jitter_m;   ///< Uniform, in both directions: no structure is perfectly regular.
  double rcs_dbm2;
  double detection_probability;
};

constexpr std::array<BlockKind, 4> kStreetBlocks{{
    {20.0, 60.0, 0.5, 2.0, 3.0, 0.4, -2.0, 0.75},  // guard rail: a post every 3 m
    {15.0, 50.0, 4.0, 12.0, 2.5, 0.6, 2.0, 0.7},   // wall of houses
    {18.0, 42.0, 0.4, 0.8, 3.0, 0.8, 8.0, 0.85},   // parked cars, two corners each
    {30.0, 80.0, 1.0, 4.0, 12.0, 2.0, 0.0, 0.9},   // trees and lamp posts
}};

constexpr std::array<BlockKind, 3> kGarageBlocks{{
    {10.0, 20.0, 0.2, 0.4, 2.5, 0.2, 2.0, 0.85},  // pillars between parking places
    {10.0, 25.0, 0.2, 0.8, 1.25, 0.4, 8.0, 0.8},  // parked cars, two corners each
    {8.0, 15.0, 0.5, 1.5, 2.0, 1.0, -2.0, 0.6},   // walls with pipes, doors, ledges
}};

class Builder {
 public:
  Builder(const Road& road, const WorldOptions& options, Random& random)
      : road_(road), options_(options), random_(random), road_grid_(kCellM) {
    const auto count = static_cast<int>((road_.length_m() + 2.0 * kMarginM) / kRoadSpacingM);
    for (int i = 0; i <= count; ++i) {
      const Pose2 pose = road_.at(i * kRoadSpacingM - kMarginM).pose;
      road_grid_.insert(pose.x_m, pose.y_m, road_points_.size());
      road_points_.push_back(pose);
    }
  }

  void build_side(double side) {
    switch (options_.roadside) {
      case Roadside::street:
        return build_blocks(kStreetBlocks, options_.built_share, side);
      case Roadside::garage:
        return build_blocks(kGarageBlocks, 1.0, side);
      case Roadside::tunnel:
        return build_tunnel_side(side);
    }
  }

  void scatter_clutter() {
    const double begin_m = -kMarginM;
    const double end_m = road_.length_m() + kMarginM;
    const auto count = static_cast<std::size_t>((end_m - begin_m) * options_.clutter_per_m);
    for (std::size_t i = 0; i < count; ++i) {
      const RoadPoint point = road_.at(random_.uniform(begin_m, end_m));
      const double left_m = random_.uniform(-kClutterReachM, kClutterReachM);
      const double rcs_dbm2 = random_.uniform(-8.0, 6.0);
      place(beside(point, left_m), rcs_dbm2, random_.uniform(0.3, 0.8));
    }
  }

  void fill_area() {
    const auto [least_x, most_x] = range_of(&Pose2::x_m);
    const auto [least_y, most_y] = range_of(&Pose2::y_m);
    const double area_m2 = (most_x - least_x) * (most_y - least_y);
    const auto count = static_cast<std::size_t>(area_m2 * options_.clutter_per_m2);
    for (std::size_t i = 0; i < count; ++i) {
      const double x_m = random_.uniform(least_x, most_x);
      const double y_m = random_.uniform(least_y, most_y);
      const double rcs_dbm2 = random_.uniform(-8.0, 6.0);
      place({x_m, y_m, 0.0}, rcs_dbm2, random_.uniform(0.3, 0.8));
    }
  }

  std::vector<Reflector> take() { return std::move(reflectors_); }

 private:
  /// Range of a coordinate of the road, extended by kClutterReachM.
  [[nodiscard]] std::pair<double, double> range_of(double Pose2::*coordinate) const {
    std::pair<double, double> range{kNoLimit, -kNoLimit};
    for (double along_m = 0.0; along_m <= road_.length_m(); along_m += kRoadSpacingM) {
      const double value = road_.at(along_m).pose.*coordinate;
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
    return {range.first - kClutterReachM, range.second + kClutterReachM};
  }

  /// Distance of the edge of the free space from the path of the rear axle.
  [[nodiscard]] double edge_m(double side) const {
    const bool has_left_lanes = side > 0.0 && options_.roadside != Roadside::garage;
    return kClearanceM + (has_left_lanes ? kLeftLanesM : 0.0);
  }

  void build_blocks(std::span<const BlockKind> kinds, double share, double side) {
    double start_m = -kMarginM;
    while (start_m < road_.length_m() + kMarginM) {
      const BlockKind& kind = kinds[random_.index(kinds.size())];
      const double length_m = random_.uniform(kind.least_length_m, kind.greatest_length_m);
      if (random_.chance(share)) build_block(kind, side, start_m, length_m);
      start_m += length_m;
    }
  }

  void build_tunnel_side(double side) {
    const double offset_m = edge_m(side) + kTunnelOffsetM;
    for (double along_m = -kMarginM; along_m < road_.length_m() + kMarginM;
         along_m += kTunnelSpacingM) {
      const RoadPoint point = road_.at(along_m + random_.uniform(0.0, kTunnelSpacingM));
      place(beside(point, side * offset_m), -2.0 + 3.0 * random_.normal(), kTunnelProbability);
    }
  }

  void build_block(const BlockKind& kind, double side, double start_m, double length_m) {
    const double offset_m =
        edge_m(side) + random_.uniform(kind.least_offset_m, kind.greatest_offset_m);
    const auto count = static_cast<int>(std::ceil(length_m / kind.spacing_m));
    for (int i = 0; i < count; ++i) {
      const double jitter_m = random_.uniform(-kind.jitter_m, kind.jitter_m);
      const RoadPoint point = road_.at(start_m + i * kind.spacing_m + jitter_m);
      const double left_m = side * (offset_m + random_.uniform(0.0, 0.3));
      place(beside(point, left_m), kind.rcs_dbm2 + 3.0 * random_.normal(),
            kind.detection_probability);
    }
  }

  void place(const Pose2& where, double rcs_dbm2, double detection_probability) {
    if (on_road(where)) return;
    reflectors_.push_back({where.x_m, where.y_m, rcs_dbm2, detection_probability});
  }

  [[nodiscard]] bool on_road(const Pose2& where) const {
    bool found = false;
    road_grid_.visit_near(where.x_m, where.y_m, kClearanceM, [&](std::size_t index) {
      const Pose2& pose = road_points_[index];
      found = found || std::hypot(pose.x_m - where.x_m, pose.y_m - where.y_m) < kClearanceM;
    });
    return found;
  }

  const Road& road_;
  const WorldOptions& options_;
  Random& random_;
  std::vector<Pose2> road_points_;
  SpatialGrid road_grid_;
  std::vector<Reflector> reflectors_;
};

}  // namespace

World::World(const Road& road, const WorldOptions& options, Random random) : grid_(kCellM) {
  Builder builder(road, options, random);
  for (const double side : {1.0, -1.0}) builder.build_side(side);
  builder.scatter_clutter();
  builder.fill_area();
  reflectors_ = builder.take();
  for (std::size_t i = 0; i < reflectors_.size(); ++i) {
    grid_.insert(reflectors_[i].x_m, reflectors_[i].y_m, i);
  }
}

}  // namespace cremed
