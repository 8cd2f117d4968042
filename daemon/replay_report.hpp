// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/source/replay.hpp"

namespace cremed {

/// Counts the odometry's states by their status.
class OdometryTally final : public OdometrySink {
 public:
  void on_odometry(const Odometry& odometry) override {
    ++count_[static_cast<std::size_t>(odometry.status)];
  }
  [[nodiscard]] std::uint64_t count(OdometryStatus status) const {
    return count_[static_cast<std::size_t>(status)];
  }

 private:
  std::array<std::uint64_t, kOdometryStatusCount> count_{};
};

/// What is to be told of.
struct Replayed {
  const std::string& configuration_path;
  const Configuration& configuration;
  const Pipeline& pipeline;
  const Replay& replay;
  const OdometryTally& odometry;
  bool is_stopped = false;  ///< By a signal: what is missing may have come.
};

/// Logs what came of the logs, causes first. False if that is not what it should be: a log that
/// could not be read or has no times, a radar without a scan, no estimate at all.
bool report_replay(const Replayed& replayed);

}  // namespace cremed
