// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/live_session.hpp"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "daemon/process/clocks.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kReportPeriodUs = 1'000'000;
/// Limits the loss at a power cut; flash memory endures one write a minute.
constexpr std::int64_t kSavePeriodUs = 60'000'000;
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
                         const std::string& state_file, const volatile std::sig_atomic_t* stop)
    : learned_file_(state_file, configuration),
      configuration_(configuration),
      search_(configuration),
      source_(configuration, stop),
      publisher_(publisher_of(configuration, lcm_url)),
      feedback_(configuration, source_),
      pipeline_(configuration, source_, sinks(), PipelineClock{&realtime_us, true},
                state_file.empty() ? std::vector<std::optional<LearnedErrors>>()
                                   : learned_file_.read_and_log()),
      reporter_(configuration, pipeline_, source_, feedback_, publisher_ ? &*publisher_ : nullptr),
      next_report_us_(monotonic_us() + kReportPeriodUs),
      next_save_us_(monotonic_us() + kSavePeriodUs) {
  if (!state_file.empty()) {
    learned_writer_.emplace(state_file);
  }
  connect(monotonic_us());
}

LiveSession::~LiveSession() {
  if (learned_writer_) {
    const std::string problem = learned_writer_->finish(learned_file_.text(pipeline_.learned()));
    if (!problem.empty()) {
      spdlog::warn("state file: {}; the learned errors are not saved", problem);
    }
  }
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

/// Retries with growing pauses, up to the longest.
void LiveSession::connect(std::int64_t monotonic_us) {
  if (!publisher_ || publisher_->is_connected() || monotonic_us < next_connect_us_) {
    return;
  }
  std::string problem = publisher_->connect();
  log_.update("publishing", !problem.empty(), problem.c_str());
  connect_pause_us_ =
      std::clamp(2 * connect_pause_us_, kFirstConnectPauseUs, kLongestConnectPauseUs);
  next_connect_us_ = monotonic_us + connect_pause_us_;
}

void LiveSession::save_learned() {
  if (auto text = learned_writer_ ? learned_file_.text(pipeline_.learned()) : std::nullopt) {
    learned_writer_->offer(*std::move(text));
  }
}

void LiveSession::report_saving() {
  if (!learned_writer_) {
    return;
  }
  if (const auto problem = learned_writer_->problem()) {
    log_.update("state file", problem->empty() ? 0 : 1, [&] {
      return concat({*problem, "; the learned errors are not saved"});
    });
  }
}

void LiveSession::look_for_radars(std::int64_t monotonic_us) {
  for (const RadarPlace& place : search_.listen(source_.links(), monotonic_us)) {
    if (place.status == PlaceStatus::found) {
      use(place);
    } else {
      log_.update(configuration_.radars[place.radar].name, static_cast<int>(place.status), [&] {
        return concat({place.problem, "; waiting: ", place.remedy});
      });
    }
  }
}

/// The radar is used as if the interface had been configured by name.
void LiveSession::use(const RadarPlace& place) {
  const std::size_t radar = place.radar;
  const std::uint8_t interface =
      source_.attach(pipeline_.radars()[radar]->interface, place.interface);
  pipeline_.set_interface(radar, interface);
  feedback_.set_interface(radar, interface);
  reporter_.set_interface(radar, place.interface);
  const RadarConfiguration& found = configuration_.radars[radar];
  spdlog::info("{}: {} is on {}", found.name, found.decoder.describe(), place.interface);
}

bool LiveSession::turn(const ServiceNotifier& notifier) {
  source_.expect(pipeline_.frames_to_next_scan());
  CanFrame frame;
  const SourceEvent event = source_.next(frame);
  if (event == SourceEvent::frame) {
    feedback_.hear(frame);
  }
  pipeline_.on_event(event, frame);
  const std::int64_t now_us = monotonic_us();
  if (!search_.is_over()) {
    look_for_radars(now_us);
  }
  if (now_us >= next_report_us_) {
    next_report_us_ = now_us + kReportPeriodUs;
    connect(now_us);
    report_saving();
    notifier.status(reporter_.report());
  }
  if (now_us >= next_save_us_) {
    next_save_us_ = now_us + kSavePeriodUs;
    save_learned();
  }
  return event != SourceEvent::end;
}

}  // namespace cremed
