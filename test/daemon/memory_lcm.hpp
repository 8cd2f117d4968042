// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// LCM within the process: receives what is published.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/output/lcm_publisher.hpp"

namespace cremed {

inline Configuration two_radars() {
  Configuration configuration;
  configuration.radars.resize(2);
  configuration.radars[0].name = "front";
  configuration.radars[1].name = "rear-left_2";
  configuration.output.publish_scans = true;
  return configuration;
}

struct Received {
  std::string channel;
  std::vector<std::uint8_t> data;
};

inline void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
  const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
  static_cast<std::vector<Received>*>(user)->push_back(
      {channel, {bytes, bytes + buffer->data_size}});
}

/// Everything published while `publish` runs on channels that match `pattern`, through LCM's
/// in-process transport; by default the channels of all sources.
inline std::vector<Received> receive(
    LcmPublisher& publisher, const std::function<void()>& publish,
    const char* pattern = "(CREMED_(EGO_MOTION|STATUS|ODOMETRY|SCAN_.*)|/.*)") {
  std::vector<Received> received;
  lcm_subscription_t* all = lcm_subscribe(publisher.handle(), pattern, on_message, &received);
  publish();
  while (lcm_handle_timeout(publisher.handle(), 20) > 0) {
  }
  lcm_unsubscribe(publisher.handle(), all);
  return received;
}

template <typename Message>
Message decode(const Received& received) {
  Message message;
  REQUIRE(message.decode(received.data.data(), 0, static_cast<int>(received.data.size())) ==
          static_cast<int>(received.data.size()));
  return message;
}

inline EgoMotion turning() {
  EgoMotion motion;
  motion.utime_start_us = 5'000'000;
  motion.utime_us = 5'075'000;
  motion.status = MotionStatus::ok;
  motion.motion << 0.7, -0.01, 0.02;
  motion.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  motion.targets = 88;
  motion.iterations = 7;
  return motion;
}

inline constexpr std::size_t kOneDatagram = 1472 - 8;  // LCM's own header takes 8 bytes

}  // namespace cremed
