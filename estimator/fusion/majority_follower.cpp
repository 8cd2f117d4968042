// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/majority_follower.hpp"

#include <cmath>

#include "cremed/estimator/fusion/position_fusion.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Scans used (0.75 s of three radars) after which the state does not follow a wrong first radar:
/// the others contradict one within 0.4 s.
constexpr int kMinScansOfState = 30;

}  // namespace

void MajorityFollower::note_step(double change_mps, double possible_change_mps) {
  if (condition_.used_scans() >= kMinScansOfState && std::abs(change_mps) > possible_change_mps) {
    step_ = Step{condition_.used_us(), change_mps};
  }
}

bool MajorityFollower::note_jump(double change_mps) {
  const bool is_back = step_ && reverses(change_mps, step_->mps);
  step_ = is_back ? std::nullopt : std::optional(Step{condition_.used_us(), change_mps});
  return !is_back;
}

std::optional<Eigen::Vector2d> MajorityFollower::follow(const MotionSums& majority,
                                                        std::int64_t stamp_us,
                                                        double possible_change_mps) {
  GaussianState& state = state_.gaussian;
  const Eigen::Vector2d wrong(state.mean(kSpeed), state.mean(kYawRate));
  const Eigen::Vector2d by_majority = majority.solution().head<2>();
  const Eigen::Vector2d error = by_majority - wrong;
  const double since_s = consensus_.longest_contradiction_s();
  if (consensus_.is_step(stamp_us)) {
    note_step(error.x(), possible_change_mps);
  }
  // Positions can tell which speed is wrong once the ways at the two speeds are that far apart.
  if (has_stepped() || (std::abs(error.x()) * since_s > 2.0 * PositionFusion::kMaxConfirmedM &&
                        consensus_.contradicts_positions(stamp_us))) {
    condition_.doubt();
    return std::nullopt;
  }
  for (std::size_t i = 0; i < state_.radars(); ++i) {
    if (consensus_[i].has_agreed()) {
      state_.widen_errors(i);
    } else {
      consensus_[i].forgive();
    }
  }
  state_.start_motion(by_majority, majority.covariance().topLeftCorner<2, 2>());
  // The pose errs by the error of the velocity over the time of the contradiction.
  state.add_variance(kX, squared(error.x() * since_s));
  state.add_variance(kY, squared(error.x() * since_s));
  state.add_variance(kYaw, squared(error.y() * since_s));
  return error;
}

bool MajorityFollower::is_after_step(std::size_t radar, const Eigen::Vector2d& velocity_mps) const {
  return has_stepped() && (velocity_mps.x() - state_.radar_velocity(radar).x()) * step_->mps >
                              0.5 * squared(step_->mps);
}

}  // namespace cremed
