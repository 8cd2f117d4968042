// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/configuration/bus_options.hpp"
#include "daemon/source/received_frame.hpp"

namespace cremed {

enum class CanOpenStatus : std::uint8_t {
  open,
  no_interface,  ///< No interface of this name, or it is none of CAN.
  no_can,        ///< The kernel has no raw CAN sockets.
  failed,        ///< See error.
};

struct CanOpenResult {
  CanOpenStatus status = CanOpenStatus::failed;
  int error = 0;                 ///< errno, if not open.
  const char* step = "";         ///< What failed, for the log.
  int receive_buffer_bytes = 0;  ///< What the kernel granted; less than asked for: rmem_max.
};

enum class CanReceiveStatus : std::uint8_t {
  frames,
  empty,         ///< Nothing to read now.
  network_down,  ///< Reported once when the interface goes down; the socket lives on.
  device_gone,   ///< The interface was removed: this socket stays deaf for ever.
  failed,
};

struct CanReceiveResult {
  CanReceiveStatus status = CanReceiveStatus::empty;
  int error = 0;
  std::span<const ReceivedFrame> frames;  ///< Valid until the next call.
};

/// A raw socket on one CAN interface. It receives the frames of given identifiers and all error
/// frames, classic and FD, with a stamp each; nothing is sent unless send() is called. Facts:
/// Linux, Documentation/networking/can.rst. Not thread safe; neither copied nor moved.
class CanSocket {
 public:
  static constexpr std::size_t kBatchFrames = 64;

  CanSocket() = default;
  ~CanSocket();
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;

  /// `interface_index`: the kernel's; 0: there is no such interface. `ids`: standard identifiers to
  /// let pass, without remote frames; none: everything.
  CanOpenResult open(unsigned interface_index, std::span<const std::uint32_t> ids,
                     const CanSocketOptions& options);
  /// Other identifiers than it was opened with; false: as they were, errno says why.
  bool set_ids(std::span<const std::uint32_t> ids);
  /// For tests without CAN: takes over a datagram socket that yields `can_frame`s.
  CanOpenResult adopt(int descriptor, const CanSocketOptions& options);
  void close();

  /// At most kBatchFrames that are there now; does not wait.
  CanReceiveResult receive();

  /// Hands a frame to the controller; does not wait. 0, or errno (ENOBUFS: its queue is full).
  int send(const CanFrame& frame);

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Index the interface had when it was opened: one that is made anew gets another.
  [[nodiscard]] unsigned interface_index() const { return interface_index_; }
  /// false once hardware stamps were asked for and found useless.
  [[nodiscard]] bool hardware_stamps_work() const { return hardware_stamps_work_; }

 private:
  struct Control;  // What the kernel says about a frame.
  CanOpenResult configure(const CanSocketOptions& options);
  CanOpenResult fail(const char* step);
  std::int64_t stamp_us(const Control& control);
  std::uint32_t lost_before(const Control& control);

  int descriptor_ = -1;
  unsigned interface_index_ = 0;
  bool hardware_stamps_ = false;
  bool hardware_stamps_work_ = true;
  std::int64_t last_hardware_ns_ = 0;
  std::uint32_t kernel_drops_ = 0;  // The kernel's own count, which wraps.
  std::array<ReceivedFrame, kBatchFrames> batch_{};
};

}  // namespace cremed
