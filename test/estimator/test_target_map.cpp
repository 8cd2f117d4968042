// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

constexpr Pose2 kMount{3.4, 0.2, 0.1};

/// Float storage: 60 m to 4 um.
constexpr double kStorageM = 1e-4;

TargetMap::NodePoses all_at(const Eigen::Vector3d& pose) {
  TargetMap::NodePoses poses;
  poses.fill(pose);
  return poses;
}

TargetSet targets_at(const simulation::Points& points) {
  return simulation::targets(
      simulation::observe_all(points, Eigen::Vector3d::Zero(), 1.0, kMount, {}), kMount);
}

simulation::Points points_within(double side_m, std::size_t count, std::uint64_t seed) {
  simulation::Random random(seed);
  simulation::Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(simulation::uniform(random, -side_m, side_m),
                        simulation::uniform(random, -side_m, side_m));
  }
  return points;
}

std::vector<TargetMap::Placed> near(const TargetMap& map, const Eigen::Vector2d& point,
                                    double radius_m = TargetMap::kCellM) {
  std::vector<TargetMap::Placed> found;
  map.for_each_near(point.x(), point.y(), [&](const TargetMap::Placed& placed) {
    if ((placed.at_m - point).norm() <= radius_m) {
      found.push_back(placed);
    }
  });
  return found;
}

TEST_CASE("a target is placed by the pose of its scan in its node and of its node") {
  const auto map = std::make_unique<TargetMap>();
  const Eigen::Vector2d point(20.0, -4.0);
  const TargetSet targets = targets_at({point});
  const Eigen::Vector3d node_from_scan(1.0, -0.5, 0.2);
  const Eigen::Vector3d now_from_node(-8.0, 2.0, -0.7);
  map->insert(5, targets, kMount, node_from_scan);
  map->place(all_at(now_from_node));
  const Eigen::Vector3d now_from_scan = composed_pose(now_from_node, node_from_scan);
  const auto placed_at = [&](double x_m, double y_m) -> Eigen::Vector2d {
    return composed_pose(now_from_scan, {x_m, y_m, 0.0}).head<2>();
  };
  const Eigen::Vector2d expected = placed_at(point.x(), point.y());
  const auto found = near(*map, expected, kStorageM);
  REQUIRE(found.size() == 1);
  CHECK(found[0].node == 5);
  CHECK(found[0].azimuth_rad == Approx(targets[0].bearing_rad - kMount.yaw_rad));
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(now_from_scan.z()).toRotationMatrix();
  const Eigen::Matrix2d covariance =
      turn * numeric::matrix(targets[0].covariance_m2) * turn.transpose();
  CHECK((numeric::matrix(found[0].covariance_m2) - covariance).norm() < 1e-6 * covariance.norm());
  CHECK((map->radar_m(5) - placed_at(kMount.x_m, kMount.y_m)).norm() < kStorageM);
}

TEST_CASE("an azimuth behind a radar that looks backwards is within half a turn") {
  const auto map = std::make_unique<TargetMap>();
  const Pose2 mount{-0.6, 0.6, 3.1};
  const TargetSet targets = simulation::targets(
      simulation::observe_all({{-20.0, -3.0}}, Eigen::Vector3d::Zero(), 1.0, mount, {}), mount);
  map->insert(0, targets, mount, Eigen::Vector3d::Zero());
  map->place(all_at(Eigen::Vector3d::Zero()));
  const auto found = near(*map, {-20.0, -3.0}, kStorageM);
  REQUIRE(found.size() == 1);
  CHECK(std::abs(found[0].azimuth_rad) < 0.3);
}

TEST_CASE("every target within the edge of a cell is found, also where the hash repeats") {
  // 640 m wide: each slot of the hash serves 16 cells.
  const auto map = std::make_unique<TargetMap>();
  const simulation::Points points = points_within(320.0, kMaxDetections, 1);
  for (std::size_t node = 0; node < TargetMap::kNodes; ++node) {
    map->insert(node, targets_at(points_within(320.0, kMaxDetections, node + 1)), kMount,
                Eigen::Vector3d::Zero());
  }
  map->place(all_at(Eigen::Vector3d::Zero()));
  // Each target from places around it, to the edge of the radius.
  for (const Eigen::Vector2d& point : points) {
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d from =
          point + (TargetMap::kCellM - kStorageM) *
                      Eigen::Vector2d(std::cos(0.785398 * i), std::sin(0.785398 * i));
      const auto found = near(*map, from);
      CHECK(std::any_of(found.begin(), found.end(), [&](const TargetMap::Placed& placed) {
        return placed.node == 0 && (placed.at_m - point).norm() < kStorageM;
      }));
    }
  }
}

TEST_CASE("no target is visited twice, and all are found across the seam of the hash at 160 m") {
  const auto map = std::make_unique<TargetMap>();
  const double x_m = GENERATE(-160.0, -80.0, 0.0, 80.0, 160.0);
  const simulation::Points pair{{x_m - 0.4, x_m - 0.4}, {x_m + 0.4, x_m + 0.4}};
  map->insert(0, targets_at(pair), kMount, Eigen::Vector3d::Zero());
  // The same slots of the hash.
  simulation::Points far = pair;
  for (Eigen::Vector2d& point : far) {
    point.x() += 160.0;
  }
  map->insert(1, targets_at(far), kMount, Eigen::Vector3d::Zero());
  map->place(all_at(Eigen::Vector3d::Zero()));
  for (const Eigen::Vector2d& point : pair) {
    const auto found = near(*map, point);
    REQUIRE(found.size() == 2);
    CHECK((found[0].at_m - found[1].at_m).norm() > 1.0);
    CHECK(found[0].node + found[1].node == 0);
  }
}

TEST_CASE("a dropped scan is gone, a new one replaces that of its node") {
  const auto map = std::make_unique<TargetMap>();
  CHECK(map->scans() == 0);
  const Eigen::Vector2d here(10.0, 0.0);
  const Eigen::Vector2d there(30.0, 0.0);
  map->insert(0, targets_at({here}), kMount, Eigen::Vector3d::Zero());
  map->insert(3, targets_at({here}), kMount, Eigen::Vector3d::Zero());
  map->insert(3, targets_at({there}), kMount, Eigen::Vector3d::Zero());
  map->place(all_at(Eigen::Vector3d::Zero()));
  CHECK(map->scans() == 2);
  CHECK(near(*map, here).size() == 1);
  CHECK(near(*map, there).size() == 1);
  map->drop(3);
  map->place(all_at(Eigen::Vector3d::Zero()));
  CHECK(map->scans() == 1);
  CHECK_FALSE(map->has(3));
  CHECK(map->has(0));
  CHECK(near(*map, there).empty());
  map->clear();
  map->place(all_at(Eigen::Vector3d::Zero()));
  CHECK(map->scans() == 0);
  CHECK(near(*map, here).empty());
}

TEST_CASE("a map holds full scans at all nodes, and finds them after a motion") {
  const auto map = std::make_unique<TargetMap>();
  const simulation::Points points = points_within(60.0, kMaxDetections, 2);
  TargetMap::NodePoses poses;
  for (std::size_t node = 0; node < TargetMap::kNodes; ++node) {
    map->insert(node, targets_at(points), kMount, Eigen::Vector3d::Zero());
    poses[node] = {-3.0 * static_cast<double>(node), 0.5, 0.1 * static_cast<double>(node)};
  }
  REQUIRE(map->scans() == static_cast<int>(TargetMap::kNodes));
  map->place(poses);
  for (std::size_t node = 0; node < TargetMap::kNodes; ++node) {
    std::size_t found = 0;
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d at = composed_pose(poses[node], {point.x(), point.y(), 0.0}).head<2>();
      const auto all = near(*map, at, kStorageM);
      found += std::any_of(all.begin(), all.end(),
                           [&](const TargetMap::Placed& placed) { return placed.node == node; });
    }
    CHECK(found == points.size());
  }
}

}  // namespace
}  // namespace cremed
