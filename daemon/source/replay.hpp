// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/source/candump_reader.hpp"
#include "daemon/source/frame_source.hpp"
#include "daemon/source/stamp_merge.hpp"

namespace cremed {

/// Several candump logs as one source, in the order of LiveSource: by stamp, equal stamps by
/// interface. At a finite speed it waits until a frame is due.
///
/// candump reads its sockets in turn, so lines of several interfaces are out of order by as long as
/// candump was delayed. With several interfaces a log is read 0.5 s ahead. A line older than that
/// is of another clock, or of one that was set: all lines before it are handed out first.
class Replay final : public FrameSource {
 public:
  /// `paths`: at least one; "-" is standard input. `interfaces`: names in the order of
  /// CanFrame::interface. `speed`: log seconds per second; 0: as fast as possible. Setting `*stop`
  /// ends it. Throws std::runtime_error if a log cannot be opened or has another format.
  Replay(const std::vector<std::string>& paths, std::vector<std::string> interfaces, double speed,
         const volatile std::sig_atomic_t* stop);

  /// Throws std::runtime_error at the first line of a pipe with another format.
  SourceEvent next(CanFrame& frame) override;

  [[nodiscard]] const std::deque<CandumpReader>& logs() const { return logs_; }
  /// Whether the interface with that index had a frame.
  [[nodiscard]] bool has_frames(std::size_t interface) const { return has_frames_[interface]; }
  /// Interfaces in the logs without a configured radar; the first few.
  [[nodiscard]] const std::set<std::string>& other_interfaces() const { return other_interfaces_; }
  /// Time span of the frames handed out, without jumps of the log's clock.
  [[nodiscard]] double traffic_s() const { return traffic_s_; }
  /// Of the last frame handed out.
  [[nodiscard]] std::int64_t last_stamp_us() const { return last_stamp_us_; }
  /// Of the bytes of all logs, 0 to 1; nothing if one is a pipe.
  [[nodiscard]] std::optional<double> share_read() const;

 private:
  /// Reading state of a log.
  struct Reading {
    std::int64_t newest_us = 0;
    bool has_begun = false;
    bool is_at_end = false;
    std::optional<ReceivedFrame> held;  // Waits for the lines before it to be handed out.
  };
  [[nodiscard]] std::size_t lane(std::size_t log, std::size_t interface) const;
  [[nodiscard]] std::optional<std::size_t> log_to_read() const;
  [[nodiscard]] bool any_lane(std::size_t log, bool (StampMerge::*is)(std::size_t) const) const;
  void read(std::size_t log);
  void receive(std::size_t log, const CandumpLine& line);
  void note_loss(std::size_t log, const CandumpLine& line);
  void add(std::size_t log, const ReceivedFrame& frame);
  void release_held();
  void set_read_until(std::size_t log, std::int64_t stamp_us);
  SourceEvent take(std::size_t lane, CanFrame& frame);
  void begin_pace(std::int64_t stamp_us);
  void wait_until_due(std::int64_t stamp_us) const;

  std::deque<CandumpReader> logs_;
  std::vector<std::string> interfaces_;
  std::vector<bool> has_frames_;  // By interface.
  std::set<std::string> other_interfaces_;
  std::vector<Reading> readings_;
  std::vector<bool> has_lost_;  // By lane, before its next frame.
  StampMerge merge_;            // A lane per interface and log.
  double speed_;
  const volatile std::sig_atomic_t* stop_;
  bool has_begun_ = false;
  std::int64_t last_stamp_us_ = 0;
  double traffic_s_ = 0.0;
  std::int64_t pace_stamp_us_ = 0;  // This stamp was due at pace_us_.
  std::int64_t pace_us_ = 0;
};

}  // namespace cremed
