// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/lcm_listener.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <type_traits>

#include "daemon/output/multicast_route.hpp"

namespace cremed {
namespace {

constexpr int kWaitMs = 100;
// Of radar_scan_t: what stands before the source's length, between its end and the number of
// targets, and what a target takes.
constexpr std::size_t kBeforeSource = 24;
constexpr std::size_t kBetween = 33;
constexpr std::size_t kBytesOfTarget = 31;

/// A big-endian number; 0 beyond the end.
std::size_t number_at(const lcm_recv_buf_t& buffer, std::size_t offset) {
  const auto* const bytes = static_cast<const std::uint8_t*>(buffer.data);
  std::size_t value = 0;
  for (std::size_t i = offset; i < offset + 4 && offset + 4 <= buffer.data_size; ++i) {
    value = (value << 8U) | bytes[i];
  }
  return value;
}

/// The generated code makes room for as many targets as a scan announces before it looks whether
/// they are there.
bool announces_what_it_has(const lcm_recv_buf_t& buffer) {
  const std::size_t source = number_at(buffer, kBeforeSource);
  const std::size_t targets = number_at(buffer, kBeforeSource + 4 + source + kBetween);
  return targets * kBytesOfTarget <= buffer.data_size;
}

/// What is of another type, cut off or impossible is not taken.
template <typename Message>
void hear(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* state) {
  if (std::is_same_v<Message, radar_scan_t> && !announces_what_it_has(*buffer)) {
    return;
  }
  Message message;
  try {
    if (message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)) ==
        static_cast<int>(buffer->data_size)) {
      static_cast<HeardState*>(state)->take(message);
    }
  } catch (const std::exception&) {  // A length of 0 is taken for -1.
  }
}

}  // namespace

LcmListener::LcmListener(const std::string& url, HeardState& state) {
  if (const std::string problem = multicast_problem(url); !problem.empty()) {
    throw std::runtime_error("LCM at " + url + ": " + problem);
  }
  lcm_.reset(lcm_create(url.c_str()));
  if (lcm_ == nullptr) {
    throw std::runtime_error("LCM at " + url + " cannot be set up. A URL is like " +
                             "udpm://239.255.76.67:7667?ttl=0");
  }
  lcm_subscribe(lcm_.get(), "CREMED_ODOMETRY", hear<odometry_t>, &state);
  lcm_subscribe(lcm_.get(), "CREMED_EGO_MOTION", hear<ego_motion_t>, &state);
  lcm_subscribe(lcm_.get(), "CREMED_STATUS", hear<status_t>, &state);
  lcm_subscribe(lcm_.get(), "CREMED_SCAN_.*", hear<radar_scan_t>, &state);
}

bool LcmListener::listen() { return lcm_handle_timeout(lcm_.get(), kWaitMs) >= 0; }

}  // namespace cremed
