// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <lcm/lcm.h>

#include "tools/lcm_log_reader.hpp"
#include "tools/view/heard_state.hpp"

namespace cremed {

/// Receives cremed's messages over LCM, or plays a log of them. Publishes nothing.
class LcmListener {
 public:
  /// Throws std::runtime_error with what is wrong and how to mend it.
  LcmListener(const std::string& url, HeardState& state);

  /// Waits for messages and takes them; returns after 0.1 s without. False at the end of a log
  /// (file://), after which nothing comes any more.
  bool listen();
  /// Where a log is damaged; empty if it is not, or before its end.
  [[nodiscard]] std::string damage() const { return log_ ? log_->damage() : std::string(); }
  /// How many messages on cremed's channels are not of this version; empty: none.
  [[nodiscard]] std::string other_versions() const;

 private:
  /// What is of another type, cut off or impossible is counted, not taken.
  template <typename Message>
  static void hear(const lcm_recv_buf_t* buffer, const char* channel, void* listener);
  struct Subscription {
    std::string_view channel;  ///< With ".*": the beginning of several.
    lcm_msg_handler_t hear;
  };
  static const std::array<Subscription, 4> kSubscriptions;
  static bool is_of(const Subscription& subscription, std::string_view channel);

  /// LCM's own player crashes on a damaged log.
  bool play();

  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  HeardState& state_;
  std::unique_ptr<lcm_t, Destroy> lcm_;
  std::optional<LcmLogReader> log_;
  double speed_ = 1.0;
  std::map<std::string, std::uint64_t> other_versions_;  // By the name of the type.
  const LoggedMessage* logged_ = nullptr;                // The next, when its time comes.
  std::int64_t recorded_us_ = 0;  // When the last was recorded; 0: there was none.
  std::chrono::steady_clock::time_point due_{};
};

}  // namespace cremed
