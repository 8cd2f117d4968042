// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// State of an interface. The numbers are those of status_t.
enum class LinkState : std::uint8_t {
  none = 0,    ///< Not live: frames come from a log.
  absent = 1,  ///< No interface of this name; cremed waits for it.
  down = 2,
  up = 3,
  failed = 4,  ///< The kernel refuses a socket; retried.
};

/// State of the CAN controller according to error frames. The numbers are those of status_t.
enum class BusState : std::uint8_t {
  error_active = 0,
  warning = 1,
  error_passive = 2,
  bus_off = 3
};

/// One live bus. Counters count since the start.
struct BusStatus {
  LinkState link = LinkState::none;
  BusState bus = BusState::error_active;
  std::uint64_t frames = 0;            ///< Handed to the decoders.
  std::uint64_t frames_lost = 0;       ///< Dropped by the kernel or the controller.
  std::uint64_t frames_stale = 0;      ///< Older than max_latency_s: dropped.
  std::uint64_t frames_discarded = 0;  ///< Dropped because the clock was set.
  std::uint64_t error_frames = 0;
  std::uint64_t bus_offs = 0;
  std::uint64_t restarts = 0;       ///< Controller restarted after bus-off.
  std::uint64_t interruptions = 0;  ///< Times the interface went down or was removed.
  std::uint64_t clock_steps = 0;    ///< Steps of the computer's clock.
  std::uint64_t frames_sent = 0;    ///< Motion feedback.
  std::uint64_t send_failures = 0;
  int receive_buffer_bytes = 0;      ///< Granted by the kernel.
  bool hardware_stamps_work = true;  ///< false: configured, but unusable.
  int error = 0;                     ///< errno of the last failure.
};

}  // namespace cremed
