// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "daemon/report/report.hpp"

using namespace cremed;

namespace {

RadarConfiguration front() {
  RadarConfiguration radar;
  radar.name = "front";
  radar.interface = "can0";
  radar.decoder = Ars408Options{};
  return radar;
}

std::uint64_t& count(RadarStatus& status, MotionStatus motion) {
  return status.motions_by_status[static_cast<std::size_t>(motion)];
}

/// 100 scans of an ARS408 with an estimate each.
RadarStatus healthy() {
  RadarStatus status;
  status.source.frames = 5000;
  status.decoder.frames = 5000;
  status.assembler.scans = 100;
  status.selection.used = 2000;
  count(status, MotionStatus::ok) = 99;
  count(status, MotionStatus::no_reference) = 1;
  status.health.is_known = true;
  status.health.output = RadarHealth::Output::clusters;
  status.health.sends_quality = true;
  return status;
}

void no_estimate_but(RadarStatus& status, MotionStatus motion) {
  status.motions_by_status = {};
  count(status, motion) = 100;
}

/// No target is used: all are counted there.
std::function<void(RadarStatus&)> all_targets_are(std::uint64_t SelectionCounters::*counter) {
  return [counter](RadarStatus& status) {
    no_estimate_but(status, MotionStatus::too_few_targets);
    status.selection = {};
    status.selection.*counter = 2000;
  };
}

}  // namespace

TEST_CASE("All well: nothing is reported but the summary") {
  const RadarStatus status = healthy();
  CHECK(radar_findings(front(), status, {}).empty());
  CHECK(irregularities(status).empty());
  CHECK(summary(status) == "100 scans, 99 estimates, no_reference 1");
}

TEST_CASE("Irregularities name every counter that is not zero") {
  RadarStatus status = healthy();
  status.decoder.crc_errors = 3;
  CHECK(irregularities(status) == "frames: CRC errors 3");
  status.assembler.incomplete_scans = 2;
  status.assembler.orphan_parts = 5;
  CHECK(irregularities(status) == "frames: CRC errors 3; scans: incomplete 2, orphan parts 5");
  status.decoder = {};
  CHECK(irregularities(status) == "scans: incomplete 2, orphan parts 5");
}

TEST_CASE("Each trouble is the first finding") {
  struct Case {
    std::string name;
    std::function<void(RadarStatus&)> spoil;
    Severity severity;
    std::string what;
    std::string remedy;
  };
  const auto row = GENERATE(
      Case{"nothing on any bus", [](auto& s) { s = {}; }, Severity::error,
           "no frame with this radar's identifiers on can0", "bit rate"},
      Case{"nothing of this radar",
           [](auto& s) {
             s = {};
             s.source.frames = 7;
           },
           Severity::error, "no frame with this radar's identifiers on can0", "sensor_id"},
      Case{"objects",
           [](auto& s) {
             s.assembler = {};
             s.decoder.wrong_mode = 9;
           },
           Severity::error, "sends objects", "`cremed-doctor --configure-ars408 front`"},
      Case{"no scan whole, no report",
           [](auto& s) {
             s.assembler.incomplete_scans = 100;
             s.health = {};
           },
           Severity::error, "no scan is complete", "--configure-ars408 front"},
      Case{"empty", [](auto& s) { s.assembler.empty_scans = 100; }, Severity::error,
           "all scans are empty",
           "(0x202) let nothing pass: `cremed-doctor --ars408-filters front`"},
      Case{"no quality", [](auto& s) { s.health.sends_quality = false; }, Severity::error,
           "no quality (0x201)", "--configure-ars408 front"},
      Case{"no output", [](auto& s) { s.health.output = RadarHealth::Output::none; },
           Severity::error, "send no targets (0x201)", "--configure-ars408 front"},
      Case{"no detection has noise", all_targets_are(&SelectionCounters::no_noise), Severity::error,
           "no usable detection: no noise 2000", "covered"},
      Case{"low existence", all_targets_are(&SelectionCounters::low_existence), Severity::error,
           "no usable detection: low existence 2000", "min_existence"},
      Case{"no position", all_targets_are(&SelectionCounters::no_position), Severity::error,
           "no usable detection: no position 2000", "type"},
      Case{"outside limits", all_targets_are(&SelectionCounters::outside_limits), Severity::error,
           "no usable detection: outside limits 2000", "widen [radar.limits]"},
      Case{"invalid state", all_targets_are(&SelectionCounters::invalid_state), Severity::error,
           "no usable detection: invalid state 2000",
           "add the codes the sensor sends to keep_invalid_states"},
      Case{"most move",
           [](auto& s) {
             all_targets_are (&SelectionCounters::moving)(s);
             s.selection.invalid_state = 1999;
           },
           Severity::error, "no usable detection: invalid state 1999, moving 2000",
           "keep_dyn_props = [0, 1, 2, 3, 4, 5, 6, 7]"},
      Case{"no speed", [](auto& s) { s.health.faults = RadarHealth::speed_missing; },
           Severity::warning, "the sensor gets no speed (0x300): ", "motion_feedback = true"},
      Case{"no yaw rate", [](auto& s) { s.health.faults = RadarHealth::yaw_rate_missing; },
           Severity::warning, "the sensor gets no yaw rate (0x301): ", "keep_dyn_props"},
      Case{"no motion at all",
           [](auto& s) {
             s.health.faults = RadarHealth::speed_missing | RadarHealth::yaw_rate_missing;
           },
           Severity::warning, "no speed (0x300) and no yaw rate (0x301): ", "motion_feedback"});
  CAPTURE(row.name);
  RadarStatus status = healthy();
  row.spoil(status);
  const auto findings = radar_findings(front(), status, {});
  REQUIRE_FALSE(findings.empty());
  CHECK(findings.front().severity == row.severity);
  CHECK_THAT(findings.front().what, Catch::Contains(row.what));
  CHECK_THAT(findings.front().remedy, Catch::Contains(row.remedy));
}

TEST_CASE("Each way to end without an estimate has its own remedy") {
  struct Case {
    MotionStatus status;
    std::string remedy;
  };
  const auto row = GENERATE(Case{MotionStatus::incomplete_scan, "contradict each other"},
                            Case{MotionStatus::gap_too_long, "so rarely"},
                            Case{MotionStatus::too_few_targets, "min_targets"},
                            Case{MotionStatus::degenerate, "few fixed targets"},
                            Case{MotionStatus::no_convergence, "narrow [radar.limits]"},
                            Case{MotionStatus::non_finite, "bug"},
                            Case{MotionStatus::implausible, "invert a sign"},
                            Case{MotionStatus::ambiguous, "few fixed targets"});
  RadarStatus status = healthy();
  no_estimate_but(status, row.status);
  auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK(findings.front().severity == Severity::error);
  CHECK_THAT(findings.front().what,
             Catch::StartsWith("few scans give an estimate: ") &&
                 Catch::Contains(std::string(to_string(row.status)) + " 100"));
  CHECK_THAT(findings.front().remedy, Catch::Contains(row.remedy));
  count(status, MotionStatus::ok) = 49;
  findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK(findings.front().severity == Severity::warning);
  count(status, MotionStatus::ok) = 50;
  CHECK(radar_findings(front(), status, {}).empty());
}

TEST_CASE("Few estimates of its own are no trouble of a radar that the odometry uses") {
  RadarStatus status = healthy();
  no_estimate_but(status, MotionStatus::too_few_targets);
  count(status, MotionStatus::ok) = 20;
  status.scans_in_odometry = 50;
  CHECK(radar_findings(front(), status, {}).empty());
  status.scans_in_odometry = 49;
  CHECK(radar_findings(front(), status, {}).size() == 1);
  // None at all are: something in the configuration lets none pass.
  status.scans_in_odometry = 100;
  count(status, MotionStatus::ok) = 0;
  CHECK(radar_findings(front(), status, {}).size() == 1);
}

TEST_CASE("Each fault that a radar reports is named") {
  struct Case {
    RadarHealth::Fault fault;
    std::string name;
  };
  const auto row = GENERATE(
      Case{RadarHealth::persistent_error, "persistent error"},
      Case{RadarHealth::temporary_error, "temporary error"},
      Case{RadarHealth::temperature_error, "temperature error"},
      Case{RadarHealth::voltage_error, "voltage error"},
      Case{RadarHealth::interference, "interference"}, Case{RadarHealth::blind, "blind"},
      Case{RadarHealth::software_failure, "software failure"},
      Case{RadarHealth::can_failure, "CAN failure"},
      Case{RadarHealth::configuration_failure, "configuration failure"},
      Case{RadarHealth::not_safe, "not safe"}, Case{RadarHealth::trouble_code, "trouble code"});
  RadarConfiguration gpr = front();
  gpr.decoder = BoschGprOptions{};
  RadarStatus status = healthy();
  status.health.faults = row.fault;
  for (const RadarConfiguration& radar : {front(), gpr}) {
    const auto findings = radar_findings(radar, status, {});
    REQUIRE(findings.size() == 1);
    CHECK(findings.front().severity == Severity::warning);
    CHECK(findings.front().what == "the sensor reports a fault: " + row.name);
    CHECK_FALSE(findings.front().remedy.empty());
  }
}

TEST_CASE("Each doubt in the covariance is named with its figure and what to do") {
  struct Case {
    Doubt doubt;
    std::string what;
    std::string figure;
    std::string remedy;
  };
  const auto row = GENERATE(
      Case{registration_contradicts_doppler, "contradict their Doppler", "4.2", "sign of Doppler"},
      Case{motions_contradict_each_other, "jumps more than a vehicle's can", "5.3", "noise"},
      Case{other_radars_contradict, "contradicts the other radars", "6.4", "mount"},
      Case{covariance_too_large, "far smaller than its covariance", "4.2", "lower its noise"});
  RadarStatus status = healthy();
  status.belief = {.doppler_nis = 4.25, .next_nis = 5.35};
  status.odometry.doppler_nis = 6.45;
  CHECK(radar_findings(front(), status, {}).empty());
  status.belief.doubts = row.doubt;
  const auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == Severity::warning);
  CHECK_THAT(findings[0].what, Catch::Contains(row.what) && Catch::Contains(row.figure + ", 1"));
  CHECK_THAT(findings[0].remedy, Catch::Contains(row.remedy));
}

TEST_CASE("What is wrong with an excluded radar is named with the key that corrects it") {
  struct Case {
    FaultCause cause;
    std::string what;
    std::string remedy;
  };
  const auto row = GENERATE(
      Case{{FaultKind::scale, 1.0 / 0.9}, "10.0 % too small", "doppler_scale = 1.111"},
      Case{{FaultKind::scale, 1.0 / 1.1}, "10.0 % too large", "doppler_scale = 0.909"},
      Case{{FaultKind::sign, -1.0}, "wrong sign", "mount.yaw_rad by pi"},
      Case{{FaultKind::upside_down}, "its left is its right", "invert_azimuth"},
      Case{{FaultKind::mount_yaw, 0.1}, "5.7 degrees further left", "mount.yaw_rad = 0.35"},
      Case{{FaultKind::mount_yaw, -0.1}, "5.7 degrees further right", "mount.yaw_rad = 0.15"},
      Case{{FaultKind::mount_x, -2.0}, "2.0 m further back", "mount.x_m = 1.6"},
      Case{{FaultKind::mount_yaw, 3.0}, "171.8 degrees further left", "mount.yaw_rad = -3.033"},
      Case{{FaultKind::late, 0.3}, "0.3 s late", "stamp_offset_s = -0.25"},
      Case{{FaultKind::offset, -0.5}, "all its Doppler is 0.5 m/s off", "sensor"},
      Case{{FaultKind::exchanged, 0.0, 1}, "at the mount of rear", "interfaces"});
  RadarConfiguration radar = front();
  radar.ego_motion.vehicle_from_radar.yaw_rad = 0.25;
  radar.ego_motion.vehicle_from_radar.x_m = 3.6;
  radar.stamp_offset_s = 0.05;
  RadarConfiguration rear = front();
  rear.name = "rear";
  RadarStatus status = healthy();
  status.belief.doubts = other_radars_contradict;
  status.odometry = {.is_left_out = true, .cause = row.cause};
  const auto findings = radar_findings(radar, status, std::array{radar, rear});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what, Catch::Contains(row.what) && Catch::Contains("excluded"));
  CHECK_THAT(findings[0].remedy, Catch::Contains(row.remedy));
}

TEST_CASE("What is explained is told once, by its cause") {
  RadarStatus status = healthy();
  no_estimate_but(status, MotionStatus::ambiguous);
  status.belief.doubts = registration_contradicts_doppler;
  const std::array all{front()};
  CHECK(radar_findings(front(), status, all).size() == 2);
  status.odometry.cause = {FaultKind::mount_yaw, 0.35};
  const auto findings = radar_findings(front(), status, all);
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what, Catch::Contains("20.0 degrees further left"));
  no_estimate_but(status, MotionStatus::gap_too_long);  // Which no mount explains.
  CHECK(radar_findings(front(), status, all).size() == 2);
}

TEST_CASE("An only radar is not told that others contradict it") {
  RadarStatus status = healthy();
  status.odometry.is_left_out = true;
  CHECK_THAT(fault_finding(front(), status, std::array{front()}).what,
             Catch::StartsWith("its Doppler contradicts its positions; excluded"));
}

TEST_CASE("Radars that have one mount are told once, and not what follows from it") {
  RadarConfiguration left = front();
  left.name = "left";
  RadarStatus status = healthy();
  no_estimate_but(status, MotionStatus::ambiguous);
  status.belief.doubts = other_radars_contradict;
  const std::vector same{front(), left};
  CHECK(radar_findings(front(), status, same).empty());
  CHECK(is_contradicted(front(), status, same));
  Configuration configuration;
  configuration.radars = same;
  const auto finding = common_mount(configuration, front(), status);
  REQUIRE(finding);
  CHECK(finding->severity == Severity::error);
  CHECK_THAT(finding->what, Catch::StartsWith("front and left have the same mount (x "));
  configuration.odometry.enabled = false;
  CHECK_FALSE(common_mount(configuration, front(), status));
  configuration.odometry.enabled = true;
  configuration.radars[1].ego_motion.vehicle_from_radar.yaw_rad += 0.1;
  CHECK_FALSE(common_mount(configuration, front(), status));
  CHECK(radar_findings(front(), status, configuration.radars).size() == 1);
}

TEST_CASE("One radar above the other is well if no doubt is about the mount") {
  Configuration configuration;
  configuration.radars = {front(), front()};
  configuration.radars[1].name = "above";
  const std::uint32_t doubt = GENERATE(covariance_too_large | 0U, stamps_run_behind | 0U,
                                       motions_contradict_each_other | 0U);
  RadarStatus status = healthy();
  no_estimate_but(status, MotionStatus::ambiguous);
  status.belief.doubts = doubt;
  CHECK_FALSE(common_mount(configuration, front(), status));
  CHECK_FALSE(is_contradicted(front(), status, configuration.radars));
  CHECK(radar_findings(front(), status, configuration.radars).size() == 2);
}

TEST_CASE("Of a mount that is turned by pi no other yaw is told, but all that is of no mount") {
  constexpr std::uint32_t kOthers =
      covariance_too_large | stamps_run_behind | positions_contradict_speed;
  RadarStatus status = healthy();
  status.belief.doubts = kOthers | registration_contradicts_doppler | other_radars_contradict;
  status.odometry.cause = {FaultKind::mount_yaw, 0.3};
  drop_doubts_of_turned_mount(status);
  CHECK(status.belief.doubts == kOthers);
  CHECK(status.odometry.cause.kind == FaultKind::unknown);
  status.belief.doubts = other_radars_contradict;
  status.odometry.cause = {FaultKind::scale, 1.2};
  drop_doubts_of_turned_mount(status);
  CHECK(status.belief.doubts == other_radars_contradict);
  CHECK(status.odometry.cause.kind == FaultKind::scale);
}

TEST_CASE("A mount that the odometry has learned is named with its value") {
  RadarStatus status = healthy();
  status.odometry.cause = {FaultKind::mount_yaw, 0.1};
  const auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what,
             Catch::Contains("5.7 degrees further left") && Catch::Contains("corrects for it"));
  CHECK_THAT(findings[0].remedy, Catch::Contains("mount.yaw_rad = 0.1"));
}

TEST_CASE("A scale that the odometry has learned is named once, with its value") {
  RadarStatus status = healthy();
  status.odometry.cause = {FaultKind::scale, 1.0 / 0.95};
  status.belief.doubts = GENERATE(0U, std::uint32_t{positions_contradict_speed});
  status.belief.doppler_correction = 1.07;
  const auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what,
             Catch::Contains("5.0 % too small") && Catch::Contains("corrects for it"));
  CHECK_THAT(findings[0].remedy, Catch::Contains("calibration.doppler_scale = 1.053"));
}

TEST_CASE("No key is advised that the radar does not have, and no value that it cannot have") {
  RadarConfiguration gpr = front();
  RadarStatus status = healthy();
  const auto remedy_of = [&](const RadarConfiguration& radar, FaultCause cause) {
    status.odometry.cause = cause;
    return fault_finding(radar, status, std::array{radar}).remedy;
  };
  CHECK(remedy_of(front(), {FaultKind::sign, -1.0}) == "turn mount.yaw_rad by pi");
  gpr.decoder = BoschGprOptions();
  CHECK_THAT(remedy_of(gpr, {FaultKind::sign, -1.0}), Catch::Contains("change invert_doppler"));
  CHECK_THAT(remedy_of(gpr, {FaultKind::upside_down}), Catch::Contains("change invert_azimuth"));
  CHECK(remedy_of(front(), {FaultKind::scale, 2.5}) ==
        "the sensor or the scale of its signal is wrong");
  CHECK_THAT(remedy_of(front(), {FaultKind::scale, kDopplerScales.max}),
             Catch::Contains("doppler_scale = 2"));
  CHECK(remedy_of(front(), {FaultKind::late, 0.6}) == "find what delays its bus or its stamps");
  CHECK_THAT(remedy_of(front(), {FaultKind::unknown}),
             Catch::Contains("compare them with the vehicle") &&
                 !Catch::Contains("cremed-doctor"));  // Which prints it.
}

TEST_CASE("A speed by positions that is not Doppler's is named with its causes") {
  RadarStatus status = healthy();
  status.belief.doubts = positions_contradict_speed;
  const auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == Severity::warning);
  CHECK_THAT(findings[0].what, Catch::Contains("another speed than their Doppler"));
  CHECK_THAT(findings[0].remedy,
             Catch::Contains("over ground") && Catch::Contains("faster or slower"));
}

TEST_CASE("A wrong scale of Doppler is named with its size") {
  RadarStatus status = healthy();
  status.belief.doubts = positions_contradict_speed;
  status.belief.doppler_correction = 1.25;
  auto findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what, Catch::Contains("Doppler is 20.0 % too small"));
  CHECK_THAT(findings[0].remedy, Catch::Contains("calibration.doppler_scale"));
  status.belief.doppler_correction = 0.9;
  findings = radar_findings(front(), status, {});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what, Catch::Contains("Doppler is 11.1 % too large"));
  status.belief.doppler_correction = -1.0;
  findings = radar_findings(front(), status, std::array{front()});
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0].what, Catch::Contains("wrong sign"));
}

TEST_CASE("Whoever keeps every DynProp does not need the sensor to know its motion") {
  RadarConfiguration radar = front();
  radar.decoder.as<Ars408Options>()->keep_dyn_props = 0xFF;
  RadarStatus status = healthy();
  status.health.faults = RadarHealth::speed_missing | RadarHealth::yaw_rate_missing;
  CHECK(radar_findings(radar, status, {}).empty());
}

TEST_CASE("A finding is one line") {
  CHECK(to_text({Severity::error, "can0 is down", "`ip link set can0 up`"}) ==
        "can0 is down; `ip link set can0 up`");
}
