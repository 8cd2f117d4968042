// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "daemon/candump.hpp"
#include "test/data_tests/shared_data.hpp"
#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

struct RealDrive {
  const char* name;
  const char* configuration;
  double rmse_m;  ///< Of the reference implementation, front radar, on this scene's pairs.
  double rmse_deg;
};

std::vector<CanFrame> read_frames(const std::string& log, const Configuration& configuration) {
  const std::vector<std::string> names = interface_names(configuration);
  std::vector<CanFrame> frames;
  std::string_view rest = log;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    CandumpLine line = parse_candump_line(rest.substr(0, end));
    REQUIRE(line.status == CandumpStatus::frame);
    line.frame.interface = static_cast<std::uint8_t>(
        std::find(names.begin(), names.end(), line.interface_name) - names.begin());
    frames.push_back(line.frame);
    rest.remove_prefix(end + 1);
  }
  return frames;
}

struct DriveOutcome {
  RecordingSink sink;
  TrueTrajectory truth;
};

DriveOutcome drive(const RealDrive& scene) {
  const std::string folder = std::string("data/nuscenes/") + scene.name;
  const Configuration configuration =
      load_configuration(std::string(CREMED_SOURCE_DIR "/config/") + scene.configuration + ".toml");
  REQUIRE(configuration.radars[0].name == "front");
  const auto frames = read_frames(read_shared(folder + "/can.log.xz"), configuration);
  std::istringstream csv(read_shared(folder + "/truth.csv"));
  DriveOutcome odometry{run_pipeline(configuration.radars, frames), TrueTrajectory(csv)};
  for (std::size_t radar = 0; radar < configuration.radars.size(); ++radar) {
    CAPTURE(configuration.radars[radar].name);
    const RadarStatus& status = odometry.sink.statuses[radar].back();
    CHECK(status.assembler.scans > 240);
    CHECK(status.assembler.incomplete_scans == 0);
    // These cars never stand; a sideways radar that sees next to no Doppler must not say so.
    CHECK(count_status(odometry.sink.motions[radar], MotionStatus::standing_still) == 0);
    CHECK(credibility_of(odometry.sink.motions[radar], odometry.truth).count() >= 40);
  }
  return odometry;
}

}  // namespace

TEST_CASE(
    "Real drives: five radars give odometry, the front one and all together are precise and "
    "credible") {
  const std::vector<RealDrive> scenes = {{"scene-0061", "nuscenes-singapore", 0.01065, 0.0827},
                                         {"scene-0103", "nuscenes-boston", 0.01108, 0.0858},
                                         {"scene-0655", "nuscenes-boston", 0.01273, 0.0968},
                                         {"scene-0796", "nuscenes-singapore", 0.01188, 0.1207}};
  Credibility front(2);
  Credibility fused(3);
  for (const RealDrive& scene : scenes) {
    CAPTURE(scene.name);
    const DriveOutcome odometry = drive(scene);
    const std::vector<EgoMotion>& motions = odometry.sink.motions[0];
    const Credibility of_scene = credibility_of(motions, odometry.truth);
    std::printf("%s front: %s\n", scene.name, to_line(of_scene).c_str());
    CHECK(of_scene.count() >= 240);
    CHECK(of_scene.rmse_m() <= scene.rmse_m);
    CHECK(of_scene.rmse_deg() <= 1.01 * scene.rmse_deg);
    add(front, motions, odometry.truth);
    add(fused, odometry.sink.fused, odometry.truth);
  }
  std::printf("front: %s\nfused: %s\n", to_line(front).c_str(), to_line(fused).c_str());
  CHECK(front.rmse_m() <= 0.0110);
  CHECK(front.rmse_deg() <= 0.082);
  CHECK(fused.count() >= 1030);
  CHECK(fused.rmse_m() <= 0.0095);
  CHECK(fused.rmse_deg() <= 0.060);
  for (const Credibility* source : {&front, &fused}) {
    CHECK(source->anees() >= 0.8);
    CHECK(source->anees() <= 1.25);
  }
}
