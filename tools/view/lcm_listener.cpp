// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/lcm_listener.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <type_traits>

#include "daemon/output/multicast_route.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/joined.hpp"

namespace cremed {
namespace {

constexpr int kWaitMs = 100;
/// A longer step of a log's clock means that it was set, or that the recording paused.
constexpr std::uint64_t kLongestPauseUs = 2'000'000;
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

/// From 0 to the longest pause; stamps of a damaged log may be anything.
std::int64_t pause_us(std::int64_t from_us, std::int64_t to_us) {
  if (from_us == 0 || to_us <= from_us) {
    return 0;
  }
  const auto step_us = static_cast<std::uint64_t>(to_us) - static_cast<std::uint64_t>(from_us);
  return static_cast<std::int64_t>(std::min(step_us, kLongestPauseUs));
}

/// Of "file://LOG?speed=2", as LCM has it.
double speed_of(const std::string& url) {
  constexpr std::string_view kKey = "speed=";
  const std::size_t key = url.find(kKey, std::min(url.find('?'), url.size()));
  const double speed = key == std::string::npos ? 1.0 : std::atof(&url[key + kKey.size()]);
  return speed > 0.0 ? speed : 1.0;
}

}  // namespace

template <typename Message>
void LcmListener::hear(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* listener) {
  auto& self = *static_cast<LcmListener*>(listener);
  if (!std::is_same_v<Message, radar_scan_t> || announces_what_it_has(*buffer)) {
    try {  // Beyond are the C frames of lcm_handle().
      if (const auto message = decoded<Message>(buffer->data, buffer->data_size)) {
        self.state_.take(*message);
        return;
      }
    } catch (const std::exception&) {  // Counted as what cannot be read.
    }
  }
  ++self.other_versions_[Message::getTypeName()];
}

const std::array<LcmListener::Subscription, 4> LcmListener::kSubscriptions{
    {{"CREMED_ODOMETRY", hear<odometry_t>},
     {"CREMED_EGO_MOTION", hear<ego_motion_t>},
     {"CREMED_STATUS", hear<status_t>},
     {"CREMED_SCAN_.*", hear<radar_scan_t>}}};

bool LcmListener::is_of(const Subscription& subscription, std::string_view channel) {
  const std::size_t star = subscription.channel.find(".*");
  return channel.substr(0, star) == subscription.channel.substr(0, star);
}

LcmListener::LcmListener(const std::string& url, HeardState& state)
    : state_(state), speed_(speed_of(url)) {
  if (const std::string file = lcm_file(url); !file.empty()) {
    log_.emplace(file);
    logged_ = log_->next();
    if (logged_ == nullptr && !log_->damage().empty()) {
      throw std::runtime_error(log_->damage());
    }
    recorded_us_ = logged_ != nullptr ? logged_->recorded_us : 0;
    return;
  }
  if (const std::string problem = multicast_problem(url); !problem.empty()) {
    throw std::runtime_error("LCM at " + url + ": " + problem);
  }
  errno = 0;
  lcm_.reset(lcm_create(url.c_str()));
  if (lcm_ == nullptr) {
    throw std::runtime_error("LCM at " + url + ": " + lcm_create_problem(errno));
  }
  for (const Subscription& subscription : kSubscriptions) {
    lcm_subscribe(lcm_.get(), subscription.channel.data(), subscription.hear, this);
  }
}

bool LcmListener::listen() { return log_ ? play() : lcm_handle_timeout(lcm_.get(), kWaitMs) >= 0; }

std::string LcmListener::other_versions() const {
  const std::string counts = joined(
      other_versions_, [](const auto& of) { return std::to_string(of.second) + " " + of.first; });
  return counts.empty() ? ""
                        : "messages of another version of cremed, or damaged, are left out (" +
                              counts + "): use the tools of the version that sent them";
}

/// In the recording's pace, without its pauses.
bool LcmListener::play() {
  if (logged_ == nullptr) {
    logged_ = log_->next();
    if (logged_ == nullptr) {
      state_.end();
      return false;
    }
    const double step_us =
        static_cast<double>(pause_us(recorded_us_, logged_->recorded_us)) / speed_;
    recorded_us_ = logged_->recorded_us;
    due_ = std::max(due_, std::chrono::steady_clock::now() - std::chrono::seconds(1)) +
           std::chrono::microseconds(static_cast<std::int64_t>(step_us));
  }
  const auto now = std::chrono::steady_clock::now();
  if (now < due_) {
    std::this_thread::sleep_until(std::min(due_, now + std::chrono::milliseconds(kWaitMs)));
    return true;
  }
  lcm_recv_buf_t buffer{};
  buffer.data = const_cast<std::uint8_t*>(logged_->data.data());
  buffer.data_size = static_cast<std::uint32_t>(logged_->data.size());
  for (const Subscription& subscription : kSubscriptions) {
    if (is_of(subscription, logged_->channel)) {
      subscription.hear(&buffer, logged_->channel.c_str(), this);
    }
  }
  logged_ = nullptr;
  return true;
}

}  // namespace cremed
