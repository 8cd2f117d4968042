// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/scan/rival_speed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/median.hpp"

namespace cremed {
namespace {

/// Targets nearer than this to each other are one place: a car (2 by 4.5 m) is one or two.
constexpr float kPlaceRadiusM = 3.0F;

/// Clutter (rain, ambiguous Doppler) has votes at all speeds, and its largest group is no world. A
/// group counts if it exceeds the mean number in its width, over 5 widths on either side, by 4
/// sigma (Poisson). With 60 targets of clutter over 40 m/s two of five scans still pass.
constexpr double kWidthsBeside = 5.0;
constexpr double kClutterSigmas = 4.0;

/// Number of targets with a vote that are not near a target of an earlier vote. Counts all earlier
/// ones that are near, without branches, which is faster than to find the first.
template <typename Votes>
std::size_t count_places(const TargetSet& targets, const Votes& votes) {
  std::array<float, kMaxDetections> x_m;
  std::array<float, kMaxDetections> y_m;
  std::size_t places = 0;
  for (std::size_t k = 0; k < votes.size(); ++k) {
    const Target& here = targets[votes[k].target];
    x_m[k] = static_cast<float>(here.x_m);
    y_m[k] = static_cast<float>(here.y_m);
    int near = 0;
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      const float dx_m = x_m[earlier] - x_m[k];
      const float dy_m = y_m[earlier] - y_m[k];
      near += dx_m * dx_m + dy_m * dy_m < kPlaceRadiusM * kPlaceRadiusM ? 1 : 0;
    }
    places += near == 0 ? 1 : 0;
  }
  return places;
}

}  // namespace

double speed_along_x_mps(const Target& target, const Eigen::Vector3d& velocity,
                         const Pose2& vehicle_from_radar) {
  const double across_mps = velocity.y() + velocity.z() * vehicle_from_radar.x_m;
  const double turn_mps =
      across_mps * target.sin_bearing - velocity.z() * vehicle_from_radar.y_m * target.cos_bearing;
  return -(target.doppler_mps + turn_mps) / target.cos_bearing;
}

RivalSpeed::Votes RivalSpeed::collect(const TargetSet& targets, const Eigen::Vector3d& velocity) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    if (std::abs(target.cos_bearing) < kMinForwardCosine) {
      continue;
    }
    const double bearing_mps = velocity.x() * target.sin_bearing * target.bearing_std_rad;
    votes_[count++] = {
        speed_along_x_mps(target, velocity, vehicle_from_radar_),
        std::hypot(target.doppler_std_mps, bearing_mps) / std::abs(target.cos_bearing),
        static_cast<std::uint16_t>(i)};
  }
  return {votes_.data(), count};
}

double RivalSpeed::median_near(Votes votes, double speed_mps, double change_mps) {
  auto last = near_mps_.begin();
  for (const Vote& vote : votes) {
    if (std::abs(vote.speed_mps - speed_mps) <= kGateSigmas * vote.std_mps + change_mps) {
      *last++ = vote.speed_mps;
    }
  }
  return median_or(speed_mps, near_mps_.begin(), last);
}

RivalSpeed::Votes RivalSpeed::largest_group(Votes votes) {
  std::sort(votes.begin(), votes.end(),
            [](const Vote& a, const Vote& b) { return a.speed_mps < b.speed_mps; });
  Votes largest;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < votes.size(); ++begin) {
    const double width_mps = 2.0 * kGateSigmas * votes[begin].std_mps;
    while (end < votes.size() && votes[end].speed_mps - votes[begin].speed_mps <= width_mps) {
      ++end;
    }
    if (end > begin + largest.size()) {
      largest = votes.subspan(begin, end - begin);
    }
  }
  return largest;
}

bool RivalSpeed::is_more_than_clutter(Votes group, Votes all) {
  const double width_mps = 2.0 * kGateSigmas * group.front().std_mps;
  const double from_mps = group.front().speed_mps - kWidthsBeside * width_mps;
  const double until_mps = group.back().speed_mps + kWidthsBeside * width_mps;
  const auto near = std::count_if(all.begin(), all.end(), [&](const Vote& vote) {
    return vote.speed_mps >= from_mps && vote.speed_mps <= until_mps;
  });
  const auto size = static_cast<double>(group.size());
  const double mean = (static_cast<double>(near) - size) / (2.0 * kWidthsBeside);
  return size > mean + kClutterSigmas * std::sqrt(mean);
}

SpeedVotes RivalSpeed::count(const TargetSet& targets, const Eigen::Vector3d& velocity,
                             double change_mps) {
  const Votes votes = collect(targets, velocity);
  const double speed_mps = median_near(votes, velocity.x(), change_mps);
  const auto first_other = std::partition(votes.begin(), votes.end(), [&](const Vote& vote) {
    return std::abs(vote.speed_mps - speed_mps) <= kGateSigmas * vote.std_mps;
  });
  const Votes own(votes.begin(), first_other);
  const Votes others(first_other, votes.end());
  SpeedVotes result;
  result.own = count_places(targets, own);
  result.own_targets = own.size();
  result.own_mps = speed_mps;
  result.abeam = targets.size() - votes.size();
  const Votes rival = largest_group(others);
  if (!rival.empty() && is_more_than_clutter(rival, others)) {
    result.rival = count_places(targets, rival);
    result.rival_targets = rival.size();
    result.rival_mps = 0.5 * (rival.front().speed_mps + rival.back().speed_mps);
  }
  return result;
}

}  // namespace cremed
