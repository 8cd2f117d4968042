// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "daemon/output/nav_msgs_odometry.hpp"
#include "test/daemon/memory_lcm.hpp"
#include "test/estimator/allocation_guard.hpp"

using namespace cremed;

namespace {

constexpr const char* kChannel = "/odometry#nav_msgs.Odometry";

template <typename Message>
std::uint64_t fingerprint() {
  return static_cast<std::uint64_t>(Message::getHash());
}

Odometry driving() {
  Odometry odometry;
  odometry.utime_us = 1'700'000'000'123'456;
  odometry.status = OdometryStatus::ok;
  odometry.odom_pose << 4.0, 5.0, 0.6;
  odometry.odom_covariance << 11, 12, 13, 12, 15, 16, 13, 16, 19;
  odometry.twist << 7.0, 8.0, 9.0;
  odometry.twist_covariance << 21, 22, 23, 22, 25, 26, 23, 26, 29;
  return odometry;
}

Configuration with_channel() {
  Configuration configuration = two_radars();
  configuration.output.nav_msgs_odometry = kChannel;
  return configuration;
}

}  // namespace

// The fingerprint by which readers accept a message: a hash of the type with all nested types.
TEST_CASE("Fingerprints are those that LCM robot stacks expect") {
  CHECK(fingerprint<std_msgs::Time>() == 0xbc3a494751d96c91U);
  CHECK(fingerprint<std_msgs::Header>() == 0x2fdb11453be64af7U);
  CHECK(fingerprint<geometry_msgs::Point>() == 0xae7e5fba5eeca11eU);
  CHECK(fingerprint<geometry_msgs::Vector3>() == 0xae7e5fba5eeca11eU);
  CHECK(fingerprint<geometry_msgs::Quaternion>() == 0x363bdd3bf9180a2bU);
  CHECK(fingerprint<geometry_msgs::Pose>() == 0x245634ae2ab17b76U);
  CHECK(fingerprint<geometry_msgs::PoseWithCovariance>() == 0xce6428b127d11b5aU);
  CHECK(fingerprint<geometry_msgs::Twist>() == 0x2e7c07d7cdf7e027U);
  CHECK(fingerprint<geometry_msgs::TwistWithCovariance>() == 0xb439635a59217509U);
  CHECK(fingerprint<nav_msgs::Odometry>() == 0x94e17f94648cf0e4U);
}

TEST_CASE("nav_msgs.Odometry is published beside odometry_t, in one datagram") {
  LcmPublisher publisher("memq://", with_channel());
  REQUIRE(publisher.connect().empty());
  const auto received = receive(publisher, [&] {
    publisher.on_odometry(driving());
    publisher.on_odometry(driving());
  });
  REQUIRE(received.size() == 4);
  CHECK(received[0].channel == "CREMED_ODOMETRY");
  CHECK(received[1].channel == kChannel);
  CHECK(received[1].channel.size() + 1 + received[1].data.size() <= kOneDatagram);
  const auto m = decode<nav_msgs::Odometry>(received[1]);
  CHECK(m.header.seq == 0);
  CHECK(m.header.stamp.sec == 1'700'000'000);
  CHECK(m.header.stamp.nsec == 123'456'000);
  CHECK(m.header.frame_id == "odom");
  CHECK(m.child_frame_id == "base_link");
  CHECK(m.pose.pose.position.x == 4.0);
  CHECK(m.pose.pose.position.y == 5.0);
  CHECK(m.pose.pose.position.z == 0.0);
  CHECK(m.pose.pose.orientation.x == 0.0);
  CHECK(m.pose.pose.orientation.y == 0.0);
  CHECK(m.pose.pose.orientation.z == std::sin(0.3));
  CHECK(m.pose.pose.orientation.w == std::cos(0.3));
  CHECK(m.twist.twist.linear.x == 7.0);
  CHECK(m.twist.twist.linear.y == 8.0);
  CHECK(m.twist.twist.linear.z == 0.0);
  CHECK(m.twist.twist.angular.x == 0.0);
  CHECK(m.twist.twist.angular.z == 9.0);
  CHECK(decode<nav_msgs::Odometry>(received[3]).header.seq == 1);
}

TEST_CASE("Covariances have x, y and yaw in their places, and what is unknown is large") {
  NavMsgsOdometry odometry;
  REQUIRE(odometry.update(driving()));
  const double unknown = 1e6;
  // clang-format off
  const double pose[36] = {11, 12, 0, 0, 0, 13,
                           12, 15, 0, 0, 0, 16,
                           0, 0, unknown, 0, 0, 0,
                           0, 0, 0, unknown, 0, 0,
                           0, 0, 0, 0, unknown, 0,
                           13, 16, 0, 0, 0, 19};
  const double twist[36] = {21, 22, 0, 0, 0, 23,
                            22, 25, 0, 0, 0, 26,
                            0, 0, unknown, 0, 0, 0,
                            0, 0, 0, unknown, 0, 0,
                            0, 0, 0, 0, unknown, 0,
                            23, 26, 0, 0, 0, 29};
  // clang-format on
  for (std::size_t i = 0; i < 36; ++i) {
    CHECK(odometry.message().pose.covariance[i] == pose[i]);
    CHECK(odometry.message().twist.covariance[i] == twist[i]);
  }
}

TEST_CASE("What is not to be used is not published: the message has no status") {
  LcmPublisher publisher("memq://", with_channel());
  REQUIRE(publisher.connect().empty());
  for (std::size_t i = 0; i < kOdometryStatusCount; ++i) {
    Odometry odometry = driving();
    odometry.status = static_cast<OdometryStatus>(i);
    const bool is_usable = odometry.status == OdometryStatus::ok ||
                           odometry.status == OdometryStatus::standing_still ||
                           odometry.status == OdometryStatus::predicted;
    CHECK(receive(publisher, [&] { publisher.on_odometry(odometry); }).size() ==
          (is_usable ? 2 : 1));
  }
}

TEST_CASE("Nothing is published unless a channel is named") {
  LcmPublisher publisher("memq://", two_radars());
  REQUIRE(publisher.connect().empty());
  CHECK(receive(publisher, [&] { publisher.on_odometry(driving()); }).size() == 1);
}

TEST_CASE("A message is filled and encoded without an allocation") {
  NavMsgsOdometry odometry;
  std::array<std::uint8_t, 2048> buffer{};
  const Odometry state = driving();
  const AllocationGuard guard;
  const bool is_new = odometry.update(state);
  const int size = odometry.message().encode(buffer.data(), 0, static_cast<int>(buffer.size()));
  CHECK(AllocationGuard::stop() == 0);
  CHECK(is_new);
  CHECK(size > 600);
}
