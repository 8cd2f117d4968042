// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/map/map_nodes.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// A vehicle that moves by its state.
class Bench {
 public:
  Bench() {
    state_.start();
    set_motion(0.0, 0.0);
  }

  void set_motion(double speed_mps, double yaw_rate_radps) {
    state_.start_motion({speed_mps, yaw_rate_radps}, Eigen::Vector2d(1e-4, 1e-6).asDiagonal());
  }
  /// Moves for a time; returns whether a node was added at its end, by a scan of this age.
  bool move_and_add(double time_s, double age_s = 0.0) {
    state_.advance_to(state_.time_us() + static_cast<std::int64_t>(time_s * 1e6));
    nodes_.advance();
    return nodes_.add_if_due(state_.time_us() - static_cast<std::int64_t>(age_s * 1e6), age_s);
  }
  OdometryState& state() { return state_; }
  MapNodes& nodes() { return nodes_; }
  static const OdometryOptions& options() {
    static const OdometryOptions kOptions;
    return kOptions;
  }

 private:
  OdometryState state_{options(), {{3.4, 0.0, 0.0}}};
  MapNodes nodes_{state_};
};

TEST_CASE("the first scan gives a node, the next after the period and a motion") {
  Bench bench;
  bench.set_motion(10.0, 0.0);
  CHECK(bench.move_and_add(0.05));
  const std::size_t first = bench.nodes().newest();
  CHECK_FALSE(bench.move_and_add(0.6 * Bench::options().node_period_s));
  CHECK(bench.nodes().newest() == first);
  CHECK(bench.move_and_add(0.5 * Bench::options().node_period_s));
  CHECK(bench.nodes().newest() != first);
}

TEST_CASE("a standing vehicle keeps its map, and adds a node as soon as it has driven off") {
  Bench bench;
  CHECK(bench.move_and_add(0.05));
  for (int i = 0; i < 100; ++i) {
    CHECK_FALSE(bench.move_and_add(0.1));
  }
  bench.set_motion(1.0, 0.0);
  CHECK_FALSE(bench.move_and_add(0.9 * Bench::options().node_way_m));
  CHECK(bench.move_and_add(0.3 * Bench::options().node_way_m));
}

TEST_CASE(
    "an error of the speed adds up since a node, but for the rest before the present motion") {
  Bench bench;
  CHECK(bench.move_and_add(0.5, 0.1));
  const std::size_t node = bench.nodes().newest();
  for (int i = 0; i < 600; ++i) {
    bench.move_and_add(0.1);
  }
  CHECK(bench.nodes().since_s(node) == Approx(60.1));
  bench.set_motion(-1.0, 0.0);
  bench.move_and_add(0.1);
  bench.move_and_add(0.2);
  CHECK(bench.nodes().since_s(node) == Approx(0.2));
  bench.set_motion(0.0, 0.0);
  bench.move_and_add(0.3);
  CHECK(bench.nodes().since_s(node) == Approx(0.5));
}

TEST_CASE("after the clock was set back an error of the speed adds up since a node again") {
  Bench bench;
  bench.set_motion(10.0, 0.0);
  bench.move_and_add(100.0);
  bench.state().restart(0);
  bench.nodes().clear();
  bench.set_motion(10.0, 0.0);
  bench.move_and_add(0.1);
  const std::size_t node = bench.nodes().newest();
  bench.move_and_add(0.2);
  CHECK(bench.nodes().since_s(node) == Approx(0.2));
}

TEST_CASE("a turn on the spot is a motion, in either direction") {
  Bench bench;
  CHECK(bench.move_and_add(0.05));
  const double yaw_rate_radps = GENERATE(0.01, -0.01);
  bench.set_motion(0.0, yaw_rate_radps);
  CHECK_FALSE(bench.move_and_add(80.0 * Bench::options().node_turn_rad));
  CHECK(bench.move_and_add(40.0 * Bench::options().node_turn_rad));
}

TEST_CASE("a node is the pose at the scan, as uncertain as that") {
  Bench bench;
  bench.set_motion(10.0, 0.2);
  CHECK(bench.move_and_add(0.05));
  CHECK(bench.move_and_add(0.5, 0.1));
  const std::size_t node = bench.nodes().newest();
  const auto [pose, jacobian] = bench.state().pose_before(0.1);
  CHECK(pose.x() == Approx(4.5).margin(0.1));
  CHECK(bench.state().node_pose(node) == pose);
  const Eigen::Matrix3d covariance =
      jacobian * bench.state().gaussian.covariance().topLeftCorner<kMotionStates, kMotionStates>() *
      jacobian.transpose();
  const Eigen::Matrix3d of_node = bench.state().gaussian.covariance().block<kPose, kPose>(
      state_layout::node(node), state_layout::node(node));
  CHECK((of_node - covariance).norm() < 1e-9 * covariance.norm());
}

TEST_CASE("the newest node replaces the oldest, and the others keep their poses") {
  Bench bench;
  bench.set_motion(10.0, 0.0);
  std::vector<std::size_t> order;
  std::vector<Eigen::Vector3d> poses;
  for (std::size_t i = 0; i < 2 * kNodes; ++i) {
    REQUIRE(bench.move_and_add(0.3));
    order.push_back(bench.nodes().newest());
    poses.push_back(bench.state().node_pose(order.back()));
    CHECK(order.back() < kNodes);
    for (std::size_t k = 1; k < kNodes && k <= i; ++k) {
      CHECK(order[i - k] != order[i]);
      CHECK(bench.state().node_pose(order[i - k]) == poses[i - k]);
    }
    if (i >= kNodes) {
      CHECK(order[i] == order[i - kNodes]);
    }
  }
}

TEST_CASE("after a restart the first scan gives a node at once") {
  Bench bench;
  CHECK(bench.move_and_add(0.05));
  CHECK_FALSE(bench.move_and_add(0.01));
  bench.nodes().clear();
  CHECK(bench.move_and_add(0.01));
}

}  // namespace
}  // namespace cremed
