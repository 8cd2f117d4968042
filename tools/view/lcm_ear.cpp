// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/lcm_ear.hpp"

#include <exception>
#include <stdexcept>

#include "daemon/output/multicast_route.hpp"

namespace cremed {
namespace {

constexpr int kWaitMs = 100;

/// What is of another type, cut off or impossible is not taken.
template <typename Message>
void hear(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* state) {
  Message message;
  try {
    if (message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)) ==
        static_cast<int>(buffer->data_size)) {
      static_cast<HeardState*>(state)->take(message);
    }
  } catch (const std::exception&) {  // The generated code takes lengths as they come.
  }
}

}  // namespace

LcmEar::LcmEar(const std::string& url, HeardState& state) {
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

bool LcmEar::listen() { return lcm_handle_timeout(lcm_.get(), kWaitMs) >= 0; }

}  // namespace cremed
