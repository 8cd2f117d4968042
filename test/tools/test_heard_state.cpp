// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "tools/eval/temporary_folder.hpp"
#include "tools/view/heard_state.hpp"
#include "tools/view/lcm_listener.hpp"
#include "tools/view/thinned_path.hpp"

using namespace cremed;

namespace {

nlohmann::json json_of(const HeardState& state) { return nlohmann::json::parse(state.json()); }

/// On a straight road at 10 m/s, told 50 times a second.
odometry_t odometry(std::int64_t seq) {
  odometry_t message{};
  message.seq = seq;
  message.utime = 1'000'000'000 + 20'000 * seq;
  message.x_in_odom_frame_m = 0.2 * static_cast<double>(seq);
  message.vx_in_vehicle_frame_mps = 10.0;
  message.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps[0] = 0.04;
  message.yaw_rate_radps = std::numbers::pi / 180.0;
  return message;
}

radar_scan_t scan_of_two(const std::string& source) {
  radar_scan_t scan{};
  scan.source = source;
  scan.utime = odometry(0).utime;
  scan.num_detections = 2;
  scan.id = {1, 2};
  scan.validity = {radar_scan_t::DETECTION_USABLE, radar_scan_t::DETECTION_MOVING};
  scan.range_m = {10.0F, 20.5F};
  scan.azimuth_rad = {0.1F, -0.2F};
  scan.doppler_mps = {-9.95F, std::numeric_limits<float>::quiet_NaN()};
  scan.range_std_m = scan.azimuth_std_rad = scan.rcs_dbm2 = {0.0F, 0.0F};
  scan.doppler_std_mps = {0.1F, 0.1F};
  scan.mount_x_in_vehicle_frame_m = 3.5;
  return scan;
}

ego_motion_t motion_of(const std::string& source, std::int8_t status) {
  ego_motion_t motion{};
  motion.source = source;
  motion.status = status;
  motion.num_targets = 77;
  return motion;
}

template <typename Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> data(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(data.data(), 0, message.getEncodedSize());
  return data;
}

/// Those of two targets are scans, the others odometry.
void write_heard(const std::string& path, std::vector<std::vector<std::uint8_t>>& payloads) {
  lcm::LogFile log(path, "w");
  for (auto& payload : payloads) {
    lcm::LogEvent event{};
    event.channel = payload.size() < 200 ? "CREMED_SCAN_X" : "CREMED_ODOMETRY";
    event.data = payload.data();
    event.datalen = static_cast<int>(payload.size());
    log.writeEvent(&event);
  }
}

}  // namespace

TEST_CASE("A path of any length keeps its shape in bounded memory") {
  ThinnedPath path;
  std::size_t most = 0;
  for (int i = 0; i <= 1'000'000; ++i) {
    path.add({0.1 * i, std::sin(1e-4 * i)});
    most = std::max(most, path.points().size());
  }
  CHECK(most <= ThinnedPath::kMostPoints + 1);
  const auto& points = path.points();
  REQUIRE(points.size() > ThinnedPath::kMostPoints / 4);
  CHECK(points.front().x_m == 0.0);
  CHECK(points.back().x_m > 99'000.0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    CHECK(points[i].x_m - points[i - 1].x_m < 250.0);
  }
  path.clear();
  path.add({0.0, 0.0});
  path.add({0.3, 0.0});
  CHECK(path.points().size() == 2);
}

TEST_CASE("Nothing heard is null, not zero") {
  const HeardState state;
  const auto json = json_of(state);
  CHECK(json["messages"] == 0);
  CHECK(json["pose"].is_null());
  CHECK(json["path"]["x"].empty());
  CHECK(json["radars"].empty());
}

TEST_CASE("A radar's scans have a rate by their stamps, and a silence by the clock") {
  HeardState state;
  ego_motion_t motion = motion_of("front", ego_motion_t::STATUS_OK);
  motion.utime = 1'000'000'000;
  state.take(motion);
  CHECK(json_of(state)["radars"][0]["scan_rate_hz"].is_null());
  for (int i = 0; i < 100; ++i) {
    motion.utime += 75'000;
    state.take(motion);
  }
  CHECK(json_of(state)["radars"][0]["scan_rate_hz"].get<double>() == Approx(1.0 / 0.075));
  CHECK(json_of(state)["radars"][0]["silent_s"].get<double>() < 1.0);
  motion.utime -= 500'000'000;  // Another replay.
  state.take(motion);
  CHECK(json_of(state)["radars"][0]["scan_rate_hz"].is_null());
  CHECK(json_of(state)["pose"].is_null());
  state.take(odometry(1));
  CHECK(json_of(state)["pose"]["silent_s"].get<double>() < 1.0);
  CHECK(json_of(state)["pose"]["behind_s"].get<double>() > 1e6);
}

TEST_CASE("An hour's drive stays a minute of motion and a path") {
  HeardState state;
  for (std::int64_t seq = 0; seq <= 180'000; ++seq) {
    state.take(odometry(seq));
  }
  const auto json = json_of(state);
  CHECK(json["pose"]["x"].get<double>() == Approx(36'000.0));
  CHECK(json["pose"]["status"] == "ok");
  CHECK(json["rates"]["t"].size() <= 601);
  CHECK(json["rates"]["t"].front().get<double>() == Approx(-60.0).margin(0.11));
  CHECK(json["rates"]["vx"].back() == 10.0);
  CHECK(json["rates"]["vx_sigma"].back().get<double>() == Approx(0.2));
  CHECK(json["rates"]["yaw_rate"].back().get<double>() == Approx(1.0));
  CHECK(json["path"]["x"].size() <= ThinnedPath::kMostPoints);
  CHECK(state.json().size() < 200'000);
}

TEST_CASE("Radars keep their last motion, status and scan") {
  HeardState state;
  state.take(odometry(0));
  state.take(motion_of("front", ego_motion_t::STATUS_AMBIGUOUS));
  state.take(motion_of("fused", ego_motion_t::STATUS_OK));
  status_t status{};
  status.source = "rear";
  status.doubts = 3;
  status.figures[status_t::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_RAD] = 0.01F;
  status.latency_p99_us = 812;
  state.take(status);
  state.take(scan_of_two("front"));
  const auto json = json_of(state);
  REQUIRE(json["radars"].size() == 2);
  CHECK(json["radars"][0]["name"] == "front");
  CHECK(json["radars"][0]["motion"] == "ambiguous");
  CHECK(json["radars"][0]["targets"] == 77);
  CHECK(json["radars"][0]["status"].is_null());
  CHECK(json["radars"][1]["status"]["doubts"] ==
        nlohmann::json({"registration contradicts Doppler", "motions contradict each other"}));
  CHECK(json["radars"][1]["status"]["mount_yaw_deg"].get<double>() == Approx(0.573).margin(1e-3));
  CHECK(json["radars"][1]["status"]["latency_p99_us"] == 812);
  REQUIRE(json["scans"].size() == 1);
  CHECK(json["scans"][0]["targets"] ==
        nlohmann::json({1000, 1000, -995, 10, 0, 2050, -2000, 0, 10, 3}));
  CHECK(json["scans"][0]["mount"][0] == 3.5);
  CHECK(json["scans"][0]["twist"][0] == 10.0);
}

TEST_CASE("Scans are shown where there is no odometry") {
  HeardState state;
  state.take(scan_of_two("front"));
  CHECK(json_of(state)["scans"].size() == 1);
}

TEST_CASE("A scan that is long over is not shown") {
  HeardState state;
  state.take(odometry(0));
  state.take(scan_of_two("front"));
  CHECK(json_of(state)["scans"].size() == 1);
  state.take(odometry(100));
  CHECK(json_of(state)["scans"].empty());
}

TEST_CASE("Where the daemon begins anew, the page does") {
  HeardState state;
  for (const std::int64_t seq : {500, 501, 502}) {
    state.take(odometry(seq));
  }
  state.take(motion_of("front", ego_motion_t::STATUS_OK));
  REQUIRE(json_of(state)["path"]["x"].size() == 3);
  state.take(odometry(0));
  const auto json = json_of(state);
  CHECK(json["path"]["x"].size() == 1);
  CHECK(json["rates"]["t"].size() == 1);
  CHECK(json["radars"].empty());
}

TEST_CASE("Messages nobody should send do no harm") {
  HeardState state;
  for (int i = 0; i < 100; ++i) {
    state.take(motion_of("radar" + std::to_string(i), 99));
  }
  state.take(motion_of("\xff\xfe<script>", ego_motion_t::STATUS_OK));
  odometry_t bad = odometry(0);
  bad.status = -3;
  bad.x_in_odom_frame_m = std::numeric_limits<double>::quiet_NaN();
  state.take(bad);
  const auto json = json_of(state);
  CHECK(json["radars"].size() == 16);
  CHECK(json["radars"][0]["motion"] == "unknown");
  CHECK(json["pose"]["status"] == "unknown");
  CHECK(json["pose"]["x"].is_null());
}

TEST_CASE("What LCM brings is taken, what is cut off or lies about its size is not") {
  const TemporaryFolder folder;
  const std::string path = folder.file("log.lcm");
  std::vector<std::vector<std::uint8_t>> payloads{
      encoded(odometry(0)), encoded(scan_of_two("front")), encoded(scan_of_two("rear")),
      encoded(odometry(1))};
  payloads[0].pop_back();
  // The number of its targets, behind the source "front".
  std::fill_n(payloads[1].begin() + 24 + 4 + 6 + 33, 4, std::uint8_t{0x7F});
  write_heard(path, payloads);
  HeardState state;
  LcmListener listener("file://" + path + "?speed=0", state);
  while (listener.listen()) {
  }
  CHECK_THAT(listener.other_versions(), Catch::Contains("left out (1 odometry_t, 1 radar_scan_t)"));
  const auto json = json_of(state);
  CHECK(json["messages"] == 2);
  CHECK(json["pose"]["utime"] == odometry(1).utime);
  REQUIRE(json["radars"].size() == 1);
  CHECK(json["radars"][0]["name"] == "rear");
}

TEST_CASE("After the end of a log nothing grows old") {
  HeardState state;
  state.take(odometry(0));
  CHECK(json_of(state)["has_ended"] == false);
  state.end();
  const auto at_end = json_of(state);
  CHECK(at_end["has_ended"] == true);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(json_of(state)["silent_s"] == at_end["silent_s"]);
  CHECK(json_of(state)["pose"]["silent_s"] == at_end["pose"]["silent_s"]);
}
