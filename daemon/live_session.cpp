// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/live_session.hpp"

#include <algorithm>

#include "daemon/clocks.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kReportPeriodUs = 1'000'000;
constexpr std::int64_t kFirstConnectPauseUs = 1'000'000;
constexpr std::int64_t kLongestConnectPauseUs = 5'000'000;

std::optional<LcmPublisher> publisher_of(const Configuration& configuration,
                                         const std::string& url) {
  if (url == "none") {
    return std::nullopt;
  }
  return std::optional<LcmPublisher>(std::in_place, url, configuration);
}

}  // namespace

LiveSession::LiveSession(const Configuration& configuration, const std::string& lcm_url,
                         const volatile std::sig_atomic_t* stop)
    : source_(configuration, stop),
      publisher_(publisher_of(configuration, lcm_url)),
      feedback_(configuration, source_),
      pipeline_(configuration, source_, sinks(), PipelineClock{&realtime_us, true}),
      reporter_(configuration, pipeline_, source_, publisher_ ? &*publisher_ : nullptr),
      next_report_us_(monotonic_us() + kReportPeriodUs) {
  connect(monotonic_us());
}

std::vector<OdometrySink*> LiveSession::sinks() {
  std::vector<OdometrySink*> sinks;
  if (publisher_) {
    sinks.push_back(&*publisher_);
  }
  if (feedback_.is_needed()) {
    sinks.push_back(&feedback_);
  }
  return sinks;
}

/// Tries with growing pauses; whoever adds the route need not wait for longer than the longest.
void LiveSession::connect(std::int64_t monotonic_us) {
  if (!publisher_ || publisher_->is_connected() || monotonic_us < next_connect_us_) {
    return;
  }
  std::string problem = publisher_->connect();
  log_.update("publishing", problem.empty() ? 0 : 1, [&] { return problem; });
  connect_pause_us_ =
      std::clamp(2 * connect_pause_us_, kFirstConnectPauseUs, kLongestConnectPauseUs);
  next_connect_us_ = monotonic_us + connect_pause_us_;
}

bool LiveSession::turn(const ServiceNotifier& notifier) {
  source_.expect(pipeline_.frames_to_next_scan());
  const bool goes_on = pipeline_.take_next(source_);
  const std::int64_t now_us = monotonic_us();
  if (now_us >= next_report_us_) {
    next_report_us_ = now_us + kReportPeriodUs;
    connect(now_us);
    notifier.status(reporter_.report());
  }
  return goes_on;
}

}  // namespace cremed
