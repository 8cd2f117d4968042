// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <csignal>
#include <optional>

#include <catch2/catch.hpp>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/motion_feedback.hpp"
#include "test/daemon/moved_clock.hpp"

using namespace cremed;

namespace {

constexpr std::int64_t kScanUs = 72'000;
constexpr std::uint8_t kSensor = 3;

Configuration configuration_with(const Ars408Options& options) {
  Configuration configuration;
  RadarConfiguration radar;
  radar.name = "front";
  radar.interface = "absent";
  radar.decoder = options;
  configuration.radars.push_back(radar);
  return configuration;
}

/// A bus with a radar, and perhaps with another node that knows the motion.
class FeedbackBench {
 public:
  explicit FeedbackBench(bool is_upside_down = false)
      : configuration_(configuration_with(
            {.sensor_id = kSensor, .invert_azimuth = is_upside_down, .motion_feedback = true})) {
    std::array<int, 2> ends{};
    REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) == 0);
    bus_ = ends[0];
    source_.interfaces()[0]->adopt(ends[1]);
  }
  ~FeedbackBench() { ::close(bus_); }
  FeedbackBench(const FeedbackBench&) = delete;
  FeedbackBench& operator=(const FeedbackBench&) = delete;

  /// The seconds from now to the first frame sent; -1: none within that time.
  double first_sent_s(double within_s, const CanFrame& of_other = {}) {
    for (double passed_s = 0.0; passed_s < within_s; passed_s += 1e-6 * kScanUs) {
      stamp_us_ += kScanUs;
      hear({.id = 0x600 + 0x10 * kSensor});
      hear(of_other);
      if (sent_at_scan() != 0) {
        return passed_s;
      }
    }
    return -1.0;
  }

  void pass(double seconds) { stamp_us_ += static_cast<std::int64_t>(1e6 * seconds); }
  [[nodiscard]] bool has_rival() const { return feedback_.has_rival(0); }
  /// Of the latest frame sent.
  [[nodiscard]] std::optional<double> yaw_rate_radps() const {
    const auto reading = decode_vehicle_reading(VehicleSignal::yaw_rate, last_);
    return reading ? std::optional(reading->value) : std::nullopt;
  }

 private:
  void hear(CanFrame frame) {
    frame.stamp_us = stamp_us_;
    feedback_.hear(frame);
  }

  int sent_at_scan() {
    EgoMotion motion;
    motion.status = MotionStatus::ok;
    motion.utime_start_us = stamp_us_ - kScanUs;
    motion.utime_us = stamp_us_;
    motion.motion.z() = 0.1 * 1e-6 * kScanUs;
    feedback_.on_motion(0, motion, 0);
    int sent = 0;
    for (can_frame raw{}; ::recv(bus_, &raw, sizeof(raw), MSG_DONTWAIT) == sizeof(raw); ++sent) {
      std::copy_n(raw.data, raw.len, last_.data.begin());
      last_.length = raw.len;
    }
    CHECK((sent == 0 || sent == 2));
    return sent;
  }

  volatile std::sig_atomic_t stop_ = 0;
  Configuration configuration_;
  LiveSource source_{configuration_, &stop_};
  MotionFeedback feedback_{configuration_, source_};
  int bus_ = -1;
  CanFrame last_;
  std::int64_t stamp_us_ = 1'700'000'000'000'000;
};

CanFrame speed() { return encode_ars408_speed(kSensor, 5.0); }

}  // namespace

TEST_CASE("Before its first frame it listens for a second") {
  FeedbackBench bench;
  CHECK(bench.first_sent_s(5.0) == Approx(1.0).margin(0.15));
  CHECK(bench.first_sent_s(5.0) == 0.0);
  CHECK_FALSE(bench.has_rival());
}

TEST_CASE("A sensor mounted upside down is told the turn as it sees it") {
  for (const bool is_upside_down : {false, true}) {
    FeedbackBench bench(is_upside_down);
    REQUIRE(bench.first_sent_s(5.0) > 0.0);
    REQUIRE(bench.yaw_rate_radps());
    CHECK(*bench.yaw_rate_radps() == Approx(is_upside_down ? -0.1 : 0.1).margin(1e-3));
  }
}

TEST_CASE("While another node sends one of the two it sends none, and for 10 s after") {
  FeedbackBench bench;
  const CanFrame other = GENERATE(speed(), encode_ars408_yaw_rate(kSensor, 0.1));
  const bool begins_later = GENERATE(false, true);
  if (begins_later) {
    REQUIRE(bench.first_sent_s(5.0) > 0.0);
  }
  CHECK(bench.first_sent_s(60.0, other) == -1.0);
  CHECK(bench.has_rival());
  CHECK(bench.first_sent_s(60.0) == Approx(10.0).margin(0.15));
  CHECK_FALSE(bench.has_rival());
}

TEST_CASE("What is said to others, or is no frame of data, is no rival") {
  CanFrame extended = speed();
  extended.extended = true;
  CanFrame remote = speed();
  remote.remote = true;
  FeedbackBench bench;
  for (const CanFrame& other : {encode_ars408_speed(kSensor + 1, 5.0), extended, remote}) {
    CHECK(bench.first_sent_s(5.0, other) >= 0.0);
    CHECK_FALSE(bench.has_rival());
  }
}

TEST_CASE("Time in which the bus was not read is no silence") {
  FeedbackBench bench;
  REQUIRE(bench.first_sent_s(1.0, speed()) == -1.0);
  bench.pass(60.0);  // Stopped; or the clock was set.
  CHECK(bench.first_sent_s(5.0) == -1.0);
  bench.pass(-60.0);
  CHECK(bench.first_sent_s(60.0) == Approx(5.0).margin(0.3));
}

TEST_CASE("What the sensor is told is received if cremed is to tell it, and not otherwise") {
  for (const bool wants_feedback : {false, true}) {
    const auto ids =
        ids_on(0, configuration_with({.sensor_id = kSensor, .motion_feedback = wants_feedback}));
    for (const std::uint32_t id : {speed().id, speed().id + 1}) {
      CHECK(ids[id] == wants_feedback);
    }
  }
}
