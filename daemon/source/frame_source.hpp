// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/source/bus_status.hpp"

namespace cremed {

enum class SourceEvent : std::uint8_t {
  frame,       ///< A frame of a known interface.
  dropped,     ///< Frames were lost on `frame.interface` before the next one.
  clock_step,  ///< Live: the system clock was set; stamps before and after are not comparable.
  idle,        ///< Live: no frame to hand out; all before `frame.stamp_us` were handed out.
  end,         ///< End of input, or a stop was requested.
};

/// Counters of a source.
struct SourceCounters {
  std::uint64_t frames = 0;                  ///< Handed out.
  std::uint64_t other_interface_frames = 0;  ///< On an interface without a configured radar.
  std::uint64_t lost_frames = 0;             ///< Lost before they were read.
  std::uint64_t malformed_lines = 0;
};

/// A source of frames.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Waits for the next event; sets `frame` (for `dropped`: interface only).
  virtual SourceEvent next(CanFrame& frame) = 0;

  [[nodiscard]] const SourceCounters& counters() const { return counters_; }
  /// State of the bus; none for a log.
  [[nodiscard]] virtual BusStatus bus(std::uint8_t /*interface*/) const { return {}; }

 protected:
  FrameSource() = default;
  FrameSource(const FrameSource&) = default;
  FrameSource& operator=(const FrameSource&) = default;

  SourceCounters counters_;
};

}  // namespace cremed
