// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/learned_file.hpp"
#include "daemon/live_reporter.hpp"
#include "daemon/motion_feedback.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/output/learned_writer.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/report/service_notifier.hpp"
#include "daemon/source/live_source.hpp"
#include "daemon/source/radar_search.hpp"

namespace cremed {

/// Live operation with one configuration; a new one is made when the configuration changes.
class LiveSession {
 public:
  /// Opens what is available and retries the rest while running. `lcm_url` may be "none",
  /// `state_file` (LearnedFile) empty.
  LiveSession(const Configuration& configuration, const std::string& lcm_url,
              const std::string& state_file, const volatile std::sig_atomic_t* stop);
  /// Saves the learned errors, and logs if that fails.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// Handles one event of the buses, and once a second reports to log and service manager. false:
  /// end.
  bool turn(const ServiceNotifier& notifier);
  void finish() { pipeline_.finish(); }

 private:
  std::vector<OdometrySink*> sinks();
  void connect(std::int64_t monotonic_us);
  void look_for_radars(std::int64_t monotonic_us);
  void use(const RadarPlace& place);
  void save_learned();
  void report_saving();

  LearnedFile learned_file_;
  std::optional<LearnedWriter> learned_writer_;
  Configuration configuration_;
  RadarSearch search_;
  LiveSource source_;
  std::optional<LcmPublisher> publisher_;
  MotionFeedback feedback_;
  Pipeline pipeline_;
  LiveReporter reporter_;
  ConditionLog log_;
  std::int64_t next_report_us_ = 0;
  std::int64_t next_save_us_ = 0;
  std::int64_t next_connect_us_ = 0;
  std::int64_t connect_pause_us_ = 0;
};

}  // namespace cremed
