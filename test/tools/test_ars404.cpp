// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The type "ars404": an ARS404 sends the same frames as an ARS408.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/radar_family.hpp"
#include "daemon/configuration/configuration_summary.hpp"
#include "daemon/configuration/radar_place.hpp"
#include "test/daemon/configuration_texts.hpp"
#include "test/tools/doctor_bench.hpp"
#include "test/tools/pipeline_bench.hpp"
#include "tools/doctor/suggestion.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Configuration parse_ars404(const std::string& text) {
  Configuration configuration = parse_configuration(text, "ars404.toml");
  configuration.output.lcm_url = "none";
  return configuration;
}

HeardBus with_clusters(const std::string& interface, std::uint32_t sensor_id) {
  HeardBus bus;
  bus.interface = interface;
  bus.traffic.add({.id = 0x600 + 0x10 * sensor_id, .length = 5});
  return bus;
}

}  // namespace

TEST_CASE("An ARS404 is configured by its type, with limits of its own") {
  const Configuration configuration =
      parse_ars404(radar_text("front", "ars404", "can0") + "sensor_id = 3\n" +
                   radar_text("rear", "ars408", "can1"));
  const RadarConfiguration& front = configuration.radars.at(0);
  const auto* options = front.decoder.as<Ars408Options>();
  REQUIRE(options != nullptr);
  CHECK(options->model == Ars408Model::ars404_21);
  CHECK(options->sensor_id == 3);
  CHECK(front.decoder.label() == "ARS404 3");
  CHECK(front.decoder.describe() == "an ARS404 with sensor id 3");
  CHECK(front.ego_motion.limits.max_range_m == kArs404MaxRangeM);
  CHECK(front.ego_motion.correction.rotation_lead_s == kArs408RotationLeadS);
  CHECK(configuration.radars[1].decoder.label() == "ARS408 0");
  CHECK(configuration.radars[1].ego_motion.limits.max_range_m == DetectionLimits{}.max_range_m);
  CHECK_THAT(configuration_summary(configuration), Catch::Contains("front           ars404 "));
  const std::string nearer = radar_text("front", "ars404", "can0") + "limits.max_range_m = 50.0\n";
  CHECK(parse_ars404(nearer).radars[0].ego_motion.limits.max_range_m == 50.0);
}

TEST_CASE("It shares identifiers with an ARS408, and a search cannot distinguish them") {
  CHECK_THAT(message_of(radar_text("a", "ars404", "can0") + radar_text("b", "ars408", "can0")),
             Catch::Contains("both use CAN identifier 0x200"));
  CHECK_THAT(
      message_of(radar_text("a", "ars404", "auto") + radar_text("b", "ars408", "can0")),
      Catch::Contains("radars \"a\" and \"b\" cannot be distinguished: an ARS404 with sensor "
                      "id 0, an ARS408 with sensor id 0; must be the name"));
}

TEST_CASE("interface = \"auto\" finds it by what an ARS408 sends") {
  Configuration configuration = parse_ars404(radar_text("front", "ars404", "auto"));
  CHECK(find_interfaces({with_clusters("can0", 1)}, configuration).at(0).problem ==
        "no CAN interface shows an ARS404 with sensor id 0 (can0: an ARS404 with sensor id 1)");
  const auto places =
      find_interfaces({with_clusters("can0", 1), with_clusters("can1", 0)}, configuration);
  REQUIRE(places.size() == 1);
  CHECK(places[0].status == PlaceStatus::found);
  CHECK(configuration.radars[0].interface == "can1");
}

TEST_CASE("Its drive becomes odometry, and the doctor has no finding") {
  Configuration configuration = parse_ars404(radar_text("front", "ars404", "can0"));
  Recording traffic = recording_of(configuration.radars);
  report_state(traffic, "can0", good_state());
  CHECK(diagnose(configuration, observe(configuration, traffic)).empty());

  Recording moved = traffic;
  move_ids(moved, "can0", 0x30);
  const std::vector<Finding> findings = diagnose(configuration, observe(configuration, moved));
  REQUIRE_FALSE(findings.empty());
  CHECK(findings[0].what ==
        "front: not an ARS404 with sensor id 0 but an ARS404 with sensor id 3 is on can0");
  CHECK_THAT(findings[0].remedy, Catch::Contains("set sensor_id = 3 for radar \"front\", or give"));

  std::vector<CanFrame> frames;
  for (const BusFrame& entry : traffic) {
    frames.push_back(entry.frame);
  }
  const RecordingSink sink = run_pipeline(configuration.radars, frames);
  REQUIRE(sink.motions[0].size() > 20);
  CHECK(sink.motions[0].back().status == MotionStatus::ok);
}

TEST_CASE("One radar is recognised on its bus, and the suggestion names both types") {
  Configuration nothing;
  nothing.odometry.enabled = false;
  const Configuration configuration = parse_ars404(radar_text("front", "ars404", "can0"));
  const Observation observation = observe(nothing, recording_of(configuration.radars));
  const std::vector<RadarSettings> seen = seen_radars(observation.buses.at(0).traffic);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].is_same_radar(configuration.radars[0].decoder));
  CHECK_THAT(suggested_configuration(observation),
             Catch::Contains("type = \"ars408\"  # or \"ars404\" (see the label of the sensor): "
                             "the frames are the same\ninterface = \"can0\"\nsensor_id = 0\n"));
}
