// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/id_set.hpp"
#include "daemon/configuration/bus_options.hpp"
#include "daemon/process/descriptor.hpp"
#include "daemon/source/received_frame.hpp"

namespace cremed {

struct CanOpenResult {
  int error = ENODEV;            ///< errno; 0: open.
  int receive_buffer_bytes = 0;  ///< Granted by the kernel; limited by rmem_max.
};

struct CanReceiveResult {
  /// errno; 0: none. ENETDOWN is reported once when the interface goes down; the socket survives.
  int error = 0;
  std::span<const ReceivedFrame> frames;  ///< Valid until the next call.
};

/// Whether a socket got this error because there is no such interface, or no longer: then it never
/// receives again.
bool is_interface_gone(int error);

/// A raw socket on one CAN interface. It receives frames with given identifiers and all error
/// frames, classic and FD, with stamps, and sends only by send(). Source: Linux,
/// Documentation/networking/can.rst. Not thread safe; not copyable.
class CanSocket {
 public:
  static constexpr std::size_t kBatchFrames = 64;

  /// `interface_index`: the kernel's; 0: no such interface. `ids`: those to receive, without remote
  /// frames; none: everything.
  CanOpenResult open(unsigned interface_index, const IdSet& ids, const CanSocketOptions& options);
  /// Replaces the filter; false: unchanged, see errno.
  bool set_ids(const IdSet& ids);
  /// For tests without CAN: uses a datagram socket that delivers `can_frame`s.
  CanOpenResult adopt(int descriptor, const CanSocketOptions& options);
  void close();

  /// At most kBatchFrames that are available now; does not block.
  CanReceiveResult receive();

  /// Queues a frame for sending; does not block. 0, or errno (ENOBUFS: the queue is full).
  int send(const CanFrame& frame);

  [[nodiscard]] bool is_open() const { return descriptor_.is_open(); }
  [[nodiscard]] int descriptor() const { return descriptor_.number(); }
  /// Index of the interface when the socket was opened: a recreated interface gets another.
  [[nodiscard]] unsigned interface_index() const { return interface_index_; }
  /// false once hardware stamps have proved unusable.
  [[nodiscard]] bool hardware_stamps_work() const { return hardware_stamps_work_; }

 private:
  struct Control;  // Control data of a frame.
  CanOpenResult configure(const CanSocketOptions& options);
  CanOpenResult fail();
  std::int64_t stamp_us(const Control& control);
  std::uint32_t lost_before(const Control& control);

  Descriptor descriptor_;
  unsigned interface_index_ = 0;
  bool hardware_stamps_ = false;
  bool hardware_stamps_work_ = true;
  std::int64_t last_hardware_ns_ = 0;
  std::uint32_t kernel_drops_ = 0;  // The kernel's counter, which wraps.
  std::array<ReceivedFrame, kBatchFrames> batch_{};
};

}  // namespace cremed
