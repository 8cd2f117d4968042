// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "test/daemon/memory_lcm.hpp"

using namespace cremed;

TEST_CASE("ego_motion_t carries every field, numbered for each source on its own") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  const auto received = receive(publisher, [&] {
    publisher.on_motion(1, turning(), 450);
    publisher.on_motion(0, turning(), 0);
    publisher.on_motion(1, turning(), 0);
  });
  REQUIRE(received.size() == 3);
  const auto first = decode<ego_motion_t>(received[0]);
  CHECK(received[0].channel == "CREMED_EGO_MOTION");
  CHECK(received[0].channel.size() + 1 + received[0].data.size() <= kOneDatagram);
  CHECK(first.source == "rear-left_2");
  CHECK(first.utime == 5'075'000);
  CHECK(first.utime_start == 5'000'000);
  CHECK(first.status == ego_motion_t::STATUS_OK);
  CHECK(first.x_in_start_frame_m == 0.7);
  CHECK(first.y_in_start_frame_m == -0.01);
  CHECK(first.yaw_in_start_frame_rad == 0.02);
  const double expected[9] = {1, 2, 3, 2, 5, 6, 3, 6, 9};
  CHECK(std::memcmp(first.covariance_x_y_yaw_m_rad, expected, sizeof(expected)) == 0);
  CHECK(first.num_targets == 88);
  CHECK(first.num_iterations == 7);
  CHECK(first.solve_us == 450);
  CHECK(first.seq == 0);
  CHECK(decode<ego_motion_t>(received[1]).seq == 0);
  CHECK(decode<ego_motion_t>(received[1]).source == "front");
  CHECK(decode<ego_motion_t>(received[2]).seq == 1);
  CHECK(publisher.failures() == 0);
}

TEST_CASE("Without an estimate the message holds NaN, not zero") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  EgoMotion nothing;
  nothing.status = MotionStatus::degenerate;
  const auto received = receive(publisher, [&] { publisher.on_motion(0, nothing, 0); });
  REQUIRE(received.size() == 1);
  const auto message = decode<ego_motion_t>(received[0]);
  CHECK(message.status == ego_motion_t::STATUS_DEGENERATE);
  CHECK(std::isnan(message.x_in_start_frame_m));
  CHECK(std::isnan(message.covariance_x_y_yaw_m_rad[8]));
}

TEST_CASE("The motion of all radars goes out as \"fused\", numbered on its own") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  const auto received = receive(publisher, [&] {
    publisher.on_motion(0, turning(), 0);
    publisher.on_motion(0, turning(), 0);
    publisher.on_fused(turning(), 12);
    publisher.on_fused(turning(), 13);
  });
  REQUIRE(received.size() == 4);
  CHECK(received[2].channel == "CREMED_EGO_MOTION");
  const auto first = decode<ego_motion_t>(received[2]);
  CHECK(first.source == "fused");
  CHECK(first.seq == 0);
  CHECK(first.utime_start == 5'000'000);
  CHECK(first.x_in_start_frame_m == 0.7);
  CHECK(first.covariance_x_y_yaw_m_rad[4] == 5.0);
  CHECK(first.solve_us == 12);
  CHECK(decode<ego_motion_t>(received[3]).seq == 1);
}

TEST_CASE("Each source has a channel of its own besides, with the same bytes") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  const auto received = receive(
      publisher,
      [&] {
        publisher.on_motion(1, turning(), 0);
        publisher.on_fused(turning(), 0);
        publisher.on_status(0, RadarStatus{});
      },
      "CREMED_.*");
  std::vector<std::string> channels;
  for (std::size_t i = 0; i < received.size(); ++i) {
    channels.push_back(received[i].channel);
    CHECK(received[i].channel.size() + 1 + received[i].data.size() <= kOneDatagram);
    CHECK((i % 2 == 0 || received[i].data == received[i - 1].data));
  }
  CHECK(channels == std::vector<std::string>{"CREMED_EGO_MOTION", "CREMED_EGO_MOTION_REAR-LEFT_2",
                                             "CREMED_EGO_MOTION", "CREMED_EGO_MOTION_FUSED",
                                             "CREMED_STATUS", "CREMED_STATUS_FRONT"});
  CHECK(publisher.failures() == 0);
}

TEST_CASE("status_t says whether the covariance is to be believed") {
  CHECK(status_t::DOUBT_REGISTRATION_CONTRADICTS_DOPPLER ==
        static_cast<int>(registration_contradicts_doppler));
  CHECK(status_t::DOUBT_MOTIONS_CONTRADICT_EACH_OTHER ==
        static_cast<int>(motions_contradict_each_other));
  CHECK(status_t::DOUBT_OTHER_RADARS_CONTRADICT == static_cast<int>(other_radars_contradict));
  CHECK(status_t::DOUBT_COVARIANCE_TOO_LARGE == static_cast<int>(covariance_too_large));
  CHECK(status_t::DOUBT_POSITIONS_CONTRADICT_SPEED == static_cast<int>(positions_contradict_speed));
  CHECK(status_t::DOUBT_STAMPS_RUN_AHEAD == static_cast<int>(stamps_run_ahead));
  CHECK(status_t::DOUBT_STAMPS_RUN_BEHIND == static_cast<int>(stamps_run_behind));
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  RadarStatus status;
  status.belief = {1.5, 2.5, registration_contradicts_doppler | covariance_too_large, true};
  const auto received = receive(publisher, [&] { publisher.on_status(1, status); });
  REQUIRE(received.size() == 1);
  const auto m = decode<status_t>(received[0]);
  CHECK(m.figures[status_t::FIGURE_NIS_DOPPLER] == 1.5F);
  CHECK(m.figures[status_t::FIGURE_NIS_NEXT] == 2.5F);
  CHECK(m.doubts == 1 + 8);
  CHECK(m.speed_checked == 1);
}

TEST_CASE("status_t numbers the faults as the odometry does") {
  CHECK(status_t::CAUSE_UNKNOWN == static_cast<int>(FaultKind::unknown));
  CHECK(status_t::CAUSE_SCALE == static_cast<int>(FaultKind::scale));
  CHECK(status_t::CAUSE_SIGN == static_cast<int>(FaultKind::sign));
  CHECK(status_t::CAUSE_UPSIDE_DOWN == static_cast<int>(FaultKind::upside_down));
  CHECK(status_t::CAUSE_MOUNT_YAW == static_cast<int>(FaultKind::mount_yaw));
  CHECK(status_t::CAUSE_MOUNT_X == static_cast<int>(FaultKind::mount_x));
  CHECK(status_t::CAUSE_LATE == static_cast<int>(FaultKind::late));
  CHECK(status_t::CAUSE_EXCHANGED == static_cast<int>(FaultKind::exchanged));
  CHECK(status_t::CAUSE_OFFSET == static_cast<int>(FaultKind::offset));
}

TEST_CASE("status_t says what the odometry filter knows of the radar") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  RadarStatus status;
  status.odometry = {true,   {FaultKind::exchanged, 0.125, 1},
                     1.5,    2.5,
                     3.5,    4.5,
                     5.5,    0.25,
                     0.125,  -0.5,
                     0.0625, {7, 5, 3}};
  status.scans_in_odometry = 77;
  const auto received = receive(publisher, [&] { publisher.on_status(0, status); });
  REQUIRE(received.size() == 1);
  const auto m = decode<status_t>(received[0]);
  CHECK(m.odometry_leaves_out == 1);
  CHECK(m.odometry_fault == status_t::CAUSE_EXCHANGED);
  CHECK(m.odometry_fault_value == 0.125F);
  CHECK(m.odometry_fault_radar == 1);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_NIS_DOPPLER] == 1.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_NIS_LATERAL] == 2.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_NIS_YAW] == 3.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_DOPPLER_NOISE_FACTOR] == 4.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_POSITION_NOISE_FACTOR] == 5.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_RAD] == 0.25F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_STD_RAD] == 0.125F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR] == -0.5F);
  CHECK(m.figures[status_t::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR_STD] == 0.0625F);
  CHECK(m.counters[status_t::COUNTER_SCANS_IN_ODOMETRY] == 77);
  CHECK(m.counters[status_t::COUNTER_ODOMETRY_TARGETS_AT_REST] == 7);
  CHECK(m.counters[status_t::COUNTER_ODOMETRY_TARGETS_FOUND] == 5);
  CHECK(m.counters[status_t::COUNTER_ODOMETRY_TARGETS_MOVING] == 3);
}

TEST_CASE("odometry_t carries every field, in one datagram") {
  Odometry odometry;
  odometry.utime_us = 7'000'000;
  odometry.utime_anchor_us = 5'000'000;
  odometry.status = OdometryStatus::predicted;
  odometry.pose << 1.0, 2.0, 3.0;
  odometry.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  odometry.odom_pose << 4.0, 5.0, 6.0;
  odometry.odom_covariance << 11, 12, 13, 12, 15, 16, 13, 16, 19;
  odometry.twist << 7.0, 8.0, 9.0;
  odometry.twist_covariance << 21, 22, 23, 22, 25, 26, 23, 26, 29;
  odometry.radars = 3;
  odometry.left_out = 2;
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  const auto received = receive(publisher, [&] {
    publisher.on_odometry(odometry);
    publisher.on_odometry(odometry);
  });
  REQUIRE(received.size() == 2);
  CHECK(received[0].channel == "CREMED_ODOMETRY");
  CHECK(received[0].channel.size() + 1 + received[0].data.size() <= kOneDatagram);
  const auto m = decode<odometry_t>(received[0]);
  CHECK(m.utime == 7'000'000);
  CHECK(m.utime_anchor == 5'000'000);
  CHECK(m.status == odometry_t::STATUS_PREDICTED);
  CHECK(m.radars_used == 3);
  CHECK(m.radars_left_out == 2);
  CHECK(std::array{m.x_in_anchor_frame_m, m.y_in_anchor_frame_m, m.yaw_in_anchor_frame_rad} ==
        std::array{1.0, 2.0, 3.0});
  CHECK(std::array{m.x_in_odom_frame_m, m.y_in_odom_frame_m, m.yaw_in_odom_frame_rad} ==
        std::array{4.0, 5.0, 6.0});
  CHECK(std::array{m.vx_in_vehicle_frame_mps, m.vy_in_vehicle_frame_mps, m.yaw_rate_radps} ==
        std::array{7.0, 8.0, 9.0});
  const double anchor[9] = {1, 2, 3, 2, 5, 6, 3, 6, 9};
  const double odom[9] = {11, 12, 13, 12, 15, 16, 13, 16, 19};
  const double twist[9] = {21, 22, 23, 22, 25, 26, 23, 26, 29};
  CHECK(std::memcmp(m.covariance_x_y_yaw_in_anchor_frame_m_rad, anchor, sizeof(anchor)) == 0);
  CHECK(std::memcmp(m.covariance_x_y_yaw_in_odom_frame_m_rad, odom, sizeof(odom)) == 0);
  CHECK(std::memcmp(m.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps, twist, sizeof(twist)) ==
        0);
  CHECK(m.seq == 0);
  CHECK(decode<odometry_t>(received[1]).seq == 1);
}

TEST_CASE(
    "Doubts of a radar's status go out with its motions, those of radars used with odometry") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  RadarStatus doubted;
  doubted.belief.doubts = motions_contradict_each_other;
  Odometry by_doubted;
  by_doubted.radars = 2;
  Odometry by_other;
  by_other.radars = 1;
  const auto received = receive(publisher, [&] {
    publisher.on_status(1, doubted);
    publisher.on_motion(1, turning(), 0);
    publisher.on_motion(0, turning(), 0);
    publisher.on_odometry(by_doubted);
    publisher.on_fused(turning(), 0);
    publisher.on_odometry(by_other);
  });
  REQUIRE(received.size() == 6);
  CHECK(decode<ego_motion_t>(received[1]).doubts == status_t::DOUBT_MOTIONS_CONTRADICT_EACH_OTHER);
  CHECK(decode<ego_motion_t>(received[2]).doubts == 0);
  CHECK(decode<odometry_t>(received[3]).doubts == status_t::DOUBT_MOTIONS_CONTRADICT_EACH_OTHER);
  CHECK(decode<ego_motion_t>(received[4]).doubts == status_t::DOUBT_MOTIONS_CONTRADICT_EACH_OTHER);
  CHECK(decode<odometry_t>(received[5]).doubts == 0);
}

TEST_CASE("The statuses of the message are those of the estimator") {
  CHECK(ego_motion_t::STATUS_STANDING_STILL == static_cast<int>(MotionStatus::standing_still));
  CHECK(ego_motion_t::STATUS_NO_REFERENCE == static_cast<int>(MotionStatus::no_reference));
  CHECK(ego_motion_t::STATUS_INCOMPLETE_SCAN == static_cast<int>(MotionStatus::incomplete_scan));
  CHECK(ego_motion_t::STATUS_GAP_TOO_LONG == static_cast<int>(MotionStatus::gap_too_long));
  CHECK(ego_motion_t::STATUS_TOO_FEW_TARGETS == static_cast<int>(MotionStatus::too_few_targets));
  CHECK(ego_motion_t::STATUS_NO_CONVERGENCE == static_cast<int>(MotionStatus::no_convergence));
  CHECK(ego_motion_t::STATUS_NON_FINITE == static_cast<int>(MotionStatus::non_finite));
  CHECK(ego_motion_t::STATUS_IMPLAUSIBLE == static_cast<int>(MotionStatus::implausible));
  CHECK(ego_motion_t::STATUS_AMBIGUOUS == static_cast<int>(MotionStatus::ambiguous));
  CHECK(odometry_t::STATUS_OK == static_cast<int>(OdometryStatus::ok));
  CHECK(odometry_t::STATUS_STANDING_STILL == static_cast<int>(OdometryStatus::standing_still));
  CHECK(odometry_t::STATUS_INITIALISING == static_cast<int>(OdometryStatus::initialising));
  CHECK(odometry_t::STATUS_AMBIGUOUS == static_cast<int>(OdometryStatus::ambiguous));
  CHECK(odometry_t::STATUS_LOST == static_cast<int>(OdometryStatus::lost));
  CHECK(radar_scan_t::SCAN_DROPPED_FRAMES == static_cast<int>(ScanStatus::dropped_frames));
  CHECK(radar_scan_t::DETECTION_NO_POSITION == static_cast<int>(Validity::no_position));
  CHECK(std::size(status_t{}.motions_by_status) >= kMotionStatusCount);
}

TEST_CASE("A full scan and then an empty one go out on the radar's own channel") {
  Configuration configuration = two_radars();
  configuration.radars[1].ego_motion.vehicle_from_radar = {-0.9, 0.4, 3.0};
  LcmPublisher publisher("memq://", configuration);
  REQUIRE(publisher.connect().empty());
  RadarScan full;
  full.stamp_us = 7;
  full.counter = 65535;
  full.announced = full.count = kMaxDetections;
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    full.detections[i].id = static_cast<std::uint16_t>(i);
    full.detections[i].range_m = static_cast<double>(i) + 0.5;
    full.detections[i].validity = Validity::moving;
  }
  const auto received = receive(publisher, [&] {
    publisher.on_scan(1, full);
    publisher.on_scan(1, RadarScan{});
  });
  REQUIRE(received.size() == 2);
  CHECK(received[0].channel == "CREMED_SCAN_REAR-LEFT_2");
  const auto message = decode<radar_scan_t>(received[0]);
  REQUIRE(message.num_detections == kMaxDetections);
  CHECK(message.range_m[255] == 255.5F);
  CHECK(message.id[200] == 200);
  CHECK(message.validity[0] == radar_scan_t::DETECTION_MOVING);
  CHECK(message.counter == 65535);
  CHECK(message.mount_x_in_vehicle_frame_m == -0.9);
  CHECK(message.mount_y_in_vehicle_frame_m == 0.4);
  CHECK(message.mount_yaw_in_vehicle_frame_rad == 3.0);
  CHECK(decode<radar_scan_t>(received[1]).num_detections == 0);
}

TEST_CASE("Scans stay at home unless asked for") {
  Configuration configuration = two_radars();
  configuration.output.publish_scans = false;
  LcmPublisher publisher("memq://", configuration);
  REQUIRE(publisher.connect().empty());
  CHECK(receive(publisher, [&] { publisher.on_scan(0, RadarScan{}); }).empty());
}

TEST_CASE("status_t holds every counter and fits one datagram") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  RadarStatus status;
  status.utime_us = 99;
  status.utime_last_estimate_us = 98;
  status.last_motion_status = MotionStatus::gap_too_long;
  status.source = {1, 2, 3, 4};
  status.decoder = {5, 6, 7, 8, 9, 10, 11, 12};
  status.assembler = {13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 58};
  status.selection = {26, 27, 28, 29, 30, 31, 32};
  for (std::size_t i = 0; i < kMotionStatusCount; ++i) {
    status.motions_by_status[i] = 33 + i;
  }
  status.motions_of_incomplete_scans = 59;
  status.bus = {.link = LinkState::failed,
                .bus = BusState::bus_off,
                .frames = 44,
                .frames_lost = 45,
                .frames_stale = 46,
                .frames_discarded = 47,
                .error_frames = 48,
                .bus_offs = 49,
                .restarts = 50,
                .interruptions = 51,
                .clock_steps = 52,
                .frames_sent = 53,
                .send_failures = 54};
  status.latency = {1, 55, 56, 57};
  status.health = {.is_known = true,
                   .faults = RadarHealth::trouble_code | RadarHealth::speed_missing,
                   .output = RadarHealth::Output::clusters,
                   .sends_quality = true,
                   .max_distance_m = 196.0};
  const auto received = receive(publisher, [&] { publisher.on_status(0, status); });
  REQUIRE(received.size() == 1);
  CHECK(received[0].channel == "CREMED_STATUS");
  CHECK(received[0].channel.size() + 1 + received[0].data.size() <= kOneDatagram);
  const auto m = decode<status_t>(received[0]);
  CHECK(m.utime == 99);
  CHECK(m.utime_last_estimate == 98);
  CHECK(m.last_motion_status == ego_motion_t::STATUS_GAP_TOO_LONG);
  CHECK(m.link_state == status_t::LINK_FAILED);
  CHECK(m.bus_state == status_t::BUS_OFF);
  CHECK(m.radar_has_reported == 1);
  CHECK(m.radar_output == status_t::OUTPUT_CLUSTERS);
  CHECK(m.radar_sends_quality == 1);
  CHECK(m.figures[status_t::FIGURE_RADAR_MAX_DISTANCE_M] == 196.0F);
  CHECK(m.radar_faults == 1024 + 2048);
  // Each counter and status was given another number: every one of 1 to 59 must appear once.
  std::vector<std::int64_t> values{m.latency_p50_us, m.latency_p99_us, m.latency_max_us};
  for (const auto* list : {&m.counters[0], &m.motions_by_status[0]}) {
    const std::size_t size = list == &m.counters[0] ? std::size(m.counters) : kMotionStatusCount;
    std::copy_if(list, list + size, std::back_inserter(values),
                 [](auto value) { return value != 0; });
  }
  std::ranges::sort(values);
  REQUIRE(values.size() == 59);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(values[i] == static_cast<std::int64_t>(i + 1));
  }
  CHECK(m.counters[status_t::COUNTER_FRAMES_READ] == 1);
  CHECK(m.counters[status_t::COUNTER_CRC_ERRORS] == 11);
  CHECK(m.counters[status_t::COUNTER_SCANS_WITHOUT_HEADER] == 58);
  CHECK(m.counters[status_t::COUNTER_DETECTIONS_OUTSIDE_LIMITS] == 32);
  CHECK(m.counters[status_t::COUNTER_BUS_SEND_FAILURES] == 54);
  CHECK(m.motions_by_status[0] == 33);
}

TEST_CASE("A URL that cannot work is refused with what would be right, time and again") {
  LcmPublisher pigeon("carrier-pigeon://", two_radars());
  for (int i = 0; i < 3; ++i) {
    CHECK_THAT(pigeon.connect(), Catch::Contains("udpm://239.255.76.67:7667"));
  }
  CHECK_FALSE(pigeon.is_connected());
  CHECK_THAT(LcmPublisher("file:///nowhere/a.lcm?mode=w", two_radars()).connect(),
             Catch::EndsWith("cannot write /nowhere/a.lcm: No such file or directory"));
}

TEST_CASE("A lack of descriptors is called that, whatever lacks them") {
  rlimit usual{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &usual) == 0);
  const int first_free = ::dup(0);
  ::close(first_free);
  for (rlim_t more = 0; more < 3; ++more) {
    for (const char* url : {"memq://", "udpm://239.255.76.67:7667?ttl=0"}) {
      CAPTURE(more, url);
      const rlimit tight{static_cast<rlim_t>(first_free) + more, usual.rlim_max};
      LcmPublisher publisher(url, two_radars());
      REQUIRE(::setrlimit(RLIMIT_NOFILE, &tight) == 0);
      const std::string problem = publisher.connect();
      REQUIRE(::setrlimit(RLIMIT_NOFILE, &usual) == 0);
      // With two or three memq:// works; udpm:// may have no route here.
      if (more == 0 || !(problem.empty() || problem.find("ip route") != std::string::npos)) {
        CHECK_THAT(problem, Catch::Contains("Too many open files") && !Catch::Contains("ip route"));
      }
    }
  }
}

TEST_CASE("Without a connection every message is counted, and numbered on") {
  LcmPublisher publisher("memq://", two_radars());
  publisher.on_motion(0, turning(), 0);
  publisher.on_motion(0, turning(), 0);
  CHECK(publisher.failures() == 2);
  REQUIRE(publisher.connect().empty());
  const auto received = receive(publisher, [&] { publisher.on_motion(0, turning(), 0); });
  REQUIRE(received.size() == 1);
  CHECK(decode<ego_motion_t>(received[0]).seq == 2);
  CHECK(publisher.failures() == 2);
}
