// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// What is wrong with a radar or its configuration shows in its status within a minute, and "fused"
// goes on by the other radar.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/report.hpp"
#include "estimator/self_check.hpp"
#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

using Radars = std::vector<RadarConfiguration>;

constexpr std::size_t kFront = 0;
constexpr std::size_t kRear = 1;

Drive simulated(const std::string& name, const Radars& radars, std::uint64_t seed,
                double duration_s) {
  SimulationOptions options;
  options.seed = seed;
  options.duration_s = duration_s;
  return drive(scenario(name), radars, options);
}

const BeliefStatus& last_belief(const RecordingSink& sink, std::size_t radar) {
  return sink.statuses[radar].back().belief;
}

void print(const std::string& name, const RecordingSink& sink) {
  for (std::size_t radar = 0; radar < sink.statuses.size(); ++radar) {
    const BeliefStatus& belief = last_belief(sink, radar);
    std::printf("%-22s radar %zu: doubts %2u; Doppler %.2f, next %.2f, radars %.2f; left out %llu\n",
                name.c_str(), radar, belief.doubts, belief.doppler_innovation,
                belief.next_innovation, belief.radars_innovation,
                static_cast<unsigned long long>(belief.motions_left_out));
  }
}

/// All doubts that a radar's statuses ever showed.
std::uint32_t doubts(const RecordingSink& sink, std::size_t radar) {
  std::uint32_t result = 0;
  for (const RadarStatus& status : sink.statuses[radar]) {
    result |= status.belief.doubts;
  }
  return result;
}

/// Share of motions whose errors are within five of their own sigma, in x and yaw.
double share_within_five_sigma(const std::vector<EgoMotion>& motions, const TrueTrajectory& truth) {
  double count = 0.0;
  double within = 0.0;
  for (const EgoMotion& motion : motions) {
    const auto true_motion = truth.motion(motion.utime_start_us, motion.utime_us);
    if (motion.has_estimate() && true_motion) {
      const Eigen::Vector3d error = motion.motion - *true_motion;
      const Eigen::Vector3d sigma = motion.covariance.diagonal().cwiseSqrt();
      ++count;
      within += std::abs(error.x()) < 5.0 * sigma.x() && std::abs(error.z()) < 5.0 * sigma.z();
    }
  }
  return within / count;
}

std::vector<EgoMotion> after(const std::vector<EgoMotion>& motions, std::int64_t utime_us) {
  std::vector<EgoMotion> result;
  std::copy_if(motions.begin(), motions.end(), std::back_inserter(result),
               [&](const EgoMotion& motion) { return motion.utime_us > utime_us; });
  return result;
}

/// A fault in what the pipeline is told of a radar.
struct Fault {
  std::string name;
  std::size_t radar;
  std::function<void(RadarConfiguration&)> configure;
  std::uint32_t doubts;      ///< At least one of these, and none in the other radar.
  std::string cause;         ///< Named in the report.
  bool is_left_out = false;  ///< Of the fused motion.
};

void turn(RadarConfiguration& radar, double angle_rad) {
  radar.ego_motion.vehicle_from_radar.yaw_rad += angle_rad;
}

void scale_noise(RadarConfiguration& radar, double factor) {
  DetectionCorrection& correction = radar.ego_motion.correction;
  correction.range_std_factor = factor;
  correction.azimuth_std_factor = factor;
  correction.doppler_std_factor = factor;
}

std::vector<Fault> faults() {
  constexpr std::uint32_t kWrong =
      registration_contradicts_doppler | motions_contradict_each_other | other_radars_contradict;
  return {{"sign of Doppler", kRear,
           [](RadarConfiguration& radar) {
             std::get<BoschGprOptions>(radar.decoder).invert_doppler = true;
           },
           kWrong, "Doppler", true},
          {"front yaw 0.1 rad", kFront, [](RadarConfiguration& radar) { turn(radar, 0.1); }, kWrong,
           "mount", true},
          {"rear yaw -0.1 rad", kRear, [](RadarConfiguration& radar) { turn(radar, -0.1); }, kWrong,
           "mount", true},
          {"front reversed", kFront,
           [](RadarConfiguration& radar) { turn(radar, std::numbers::pi); }, kWrong, "mount", true},
          {"front noise / 3", kFront, [](RadarConfiguration& radar) { scale_noise(radar, 1.0 / 3); },
           kWrong, "noise"},
          {"rear noise / 3", kRear, [](RadarConfiguration& radar) { scale_noise(radar, 1.0 / 3); },
           kWrong, "noise"},
          {"front noise / 2", kFront, [](RadarConfiguration& radar) { scale_noise(radar, 0.5); },
           kWrong, "noise"},
          {"rear noise / 2", kRear, [](RadarConfiguration& radar) { scale_noise(radar, 0.5); },
           kWrong, "noise"},
          {"front noise * 10", kFront, [](RadarConfiguration& radar) { scale_noise(radar, 10.0); },
           covariance_too_large, "noise"},
          {"front noise * 5", kFront, [](RadarConfiguration& radar) { scale_noise(radar, 5.0); },
           covariance_too_large, "noise"},
          {"rear noise * 5", kRear, [](RadarConfiguration& radar) { scale_noise(radar, 5.0); },
           covariance_too_large, "noise"}};
}

}  // namespace

TEST_CASE("Self-check: a healthy drive raises no doubt") {
  const std::string name =
      GENERATE("straight", "bends", "stop-and-go", "city", "standing", "field", "reversing");
  const std::uint64_t seed = GENERATE(1U, 2U);
  CAPTURE(name, seed);
  const Drive healthy = simulated(name, default_radars(), seed, 60.0);
  const RecordingSink sink = run_pipeline(healthy.radars, healthy.frames);
  print(name, sink);
  for (const std::size_t radar : {kFront, kRear}) {
    CAPTURE(radar);
    CHECK(doubts(sink, radar) == 0);
    CHECK(last_belief(sink, radar).motions_fused > 300);
  }
}

TEST_CASE("Self-check: each fault shows within a minute, and the fused motion stays right") {
  const Drive healthy = simulated("bends", default_radars(), 3, 60.0);
  const TrueTrajectory truth = truth_of(healthy);
  for (const Fault& fault : faults()) {
    CAPTURE(fault.name);
    Radars told = healthy.radars;
    fault.configure(told[fault.radar]);
    const RecordingSink sink = run_pipeline(told, healthy.frames);
    print(fault.name, sink);
    CHECK((last_belief(sink, fault.radar).doubts & fault.doubts) != 0);
    CHECK(doubts(sink, 1 - fault.radar) == 0);
    const Credibility fused = credibility_of(sink.fused, truth);
    const Credibility other = credibility_of(sink.motions[1 - fault.radar], truth);
    const auto& faulty = sink.motions[fault.radar];
    std::printf("   faulty %s\n   %s\n",
                to_line(credibility_of(faulty, truth)).c_str(),
                summary(sink.statuses[fault.radar].back()).c_str());
    for (const auto& finding : radar_findings(told[fault.radar], sink.statuses[fault.radar].back())) {
      std::printf("   finding: %s\n", to_text(finding).c_str());
    }
    const Credibility late = credibility_of(after(sink.fused, healthy.frames.front().stamp_us + 20'000'000), truth);
    std::printf("   fused after 20 s %s\n", to_line(late).c_str());
    std::printf("   fused %s, within %.4f\n   other %s\n", to_line(fused).c_str(),
                share_within_five_sigma(sink.fused, truth), to_line(other).c_str());
  }
}

TEST_CASE("Self-check: a sensor that is knocked askew on the way shows within a minute") {
  const Drive before = simulated("bends", default_radars(), 4, 90.0);
  Radars knocked = default_radars();
  turn(knocked[kFront], 0.15);
  const Drive after = simulated("bends", knocked, 4, 90.0);
  const std::int64_t when_us = before.frames.front().stamp_us + 30'000'000;
  std::vector<CanFrame> frames;
  const auto keep = [&](const std::vector<CanFrame>& all, bool is_before) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(frames), [&](const CanFrame& frame) {
      return (frame.stamp_us < when_us) == is_before;
    });
  };
  keep(before.frames, true);
  keep(after.frames, false);
  const RecordingSink sink = run_pipeline(default_radars(), frames);
  print("knocked askew", sink);
  const TrueTrajectory truth = truth_of(before);
  const Credibility fused = credibility_of(sink.fused, truth);
  std::printf("   fused %s, within %.4f\n", to_line(fused).c_str(),
              share_within_five_sigma(sink.fused, truth));
  for (const RadarStatus& status : sink.statuses[kFront]) {
    if (status.utime_us < when_us) {
      CHECK(status.belief.doubts == 0);
    }
  }
  CHECK(last_belief(sink, kFront).doubts != 0);
  CHECK(doubts(sink, kRear) == 0);
}
