// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/candump_log.hpp"
#include "daemon/frame_source.hpp"

namespace cremed {

/// Several candump logs as one source: their events in order of time, those of the first log first
/// where stamps are equal. At a finite speed it waits until a frame is due.
class Replay final : public FrameSource {
 public:
  /// `speed`: log seconds per second; 0: as fast as possible. `logs` is not empty.
  Replay(std::vector<std::unique_ptr<CandumpLog>> logs, double speed,
         const volatile std::sig_atomic_t* stop);

  SourceEvent next(CanFrame& frame) override;

  [[nodiscard]] const std::vector<std::unique_ptr<CandumpLog>>& logs() const { return logs_; }
  /// Time the frames handed out span, without jumps of the log's clock.
  [[nodiscard]] double traffic_s() const { return traffic_s_; }

 private:
  /// The event of one log that is next in line.
  struct Pending {
    bool is_read = false;
    SourceEvent event = SourceEvent::end;
    CanFrame frame;
  };
  void read_pending();
  [[nodiscard]] std::size_t earliest() const;
  void begin_pace(std::int64_t stamp_us);
  void wait_until_due(std::int64_t stamp_us) const;

  std::vector<std::unique_ptr<CandumpLog>> logs_;
  std::vector<Pending> pending_;
  double speed_;
  const volatile std::sig_atomic_t* stop_;
  bool has_begun_ = false;
  std::int64_t last_stamp_us_ = 0;
  double traffic_s_ = 0.0;
  std::int64_t pace_stamp_us_ = 0;  // This stamp was due at pace_ns_.
  std::int64_t pace_ns_ = 0;
};

}  // namespace cremed
