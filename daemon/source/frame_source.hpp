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
  clock_step,  ///< Live: the system's clock was set; stamps before and after do not compare.
  idle,        ///< Live: nothing to read for a while; all before `frame.stamp_us` was read.
  other,       ///< Live: nothing but error frames was read.
  end,         ///< No more input, or asked to stop.
};

/// What the source read besides the frames it handed out.
struct SourceCounters {
  std::uint64_t frames = 0;                  ///< Handed out.
  std::uint64_t other_interface_frames = 0;  ///< On an interface no radar is configured for.
  std::uint64_t lost_frames = 0;             ///< Lost before they reached us.
  std::uint64_t malformed_lines = 0;
};

/// Where frames come from.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Waits for the next event; sets `frame` (for `dropped`: interface only).
  virtual SourceEvent next(CanFrame& frame) = 0;

  [[nodiscard]] const SourceCounters& counters() const { return counters_; }
  /// The bus itself; a log knows nothing of it.
  [[nodiscard]] virtual BusStatus bus(std::uint8_t /*interface*/) const { return {}; }

 protected:
  FrameSource() = default;
  FrameSource(const FrameSource&) = default;
  FrameSource& operator=(const FrameSource&) = default;

  SourceCounters counters_;
};

}  // namespace cremed
