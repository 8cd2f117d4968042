// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <sys/socket.h>

namespace cremed {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

/// Larger differences from the kernel's stamps mean that the hardware clock is not the system
/// clock: many are set at the start only, and drift by 3 ms a minute (50 ppm). A driver takes a few
/// milliseconds. The change to the kernel's stamps is then no step for ScanClock (30 ms).
constexpr std::int64_t kMaxClockDifferenceNs = 20'000'000;

std::int64_t ns_of(const timespec& time) { return time.tv_sec * kNsPerS + time.tv_nsec; }

template <typename Value>
bool set_option(int descriptor, int level, int name, const Value& value) {
  return ::setsockopt(descriptor, level, name, &value, sizeof(value)) == 0;
}

/// Filters for one exact identifier each. The flags in the mask exclude extended and remote frames.
std::vector<can_filter> filters_of(const IdSet& ids) {
  constexpr canid_t kMask = CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK;
  if (ids.none()) {
    return {{0, 0}};
  }
  if (ids.count() > CAN_RAW_FILTER_MAX) {
    return {{0, CAN_EFF_FLAG | CAN_RTR_FLAG}};
  }
  std::vector<can_filter> filters;
  for (std::size_t id = ids._Find_first(); id < ids.size(); id = ids._Find_next(id)) {
    filters.push_back({static_cast<canid_t>(id), kMask});
  }
  return filters;
}

bool set_filters(int descriptor, const IdSet& ids) {
  const std::vector<can_filter> filters = filters_of(ids);
  return ::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                      static_cast<socklen_t>(filters.size() * sizeof(can_filter))) == 0;
}

bool bind_to(int descriptor, unsigned interface_index) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(interface_index);
  return ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
}

/// The kernel reports twice the requested number.
int granted_buffer_bytes(int descriptor, int wanted) {
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, wanted)) {
    set_option(descriptor, SOL_SOCKET, SO_RCVBUF, wanted);
  }
  int granted = 0;
  socklen_t size = sizeof(granted);
  ::getsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  return granted / 2;
}

/// Clears the bytes after the length.
void fill(const canfd_frame& raw, std::size_t size, CanFrame& frame) {
  frame = {};
  frame.fd = size == CANFD_MTU;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  const std::size_t room = frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
  frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(raw.len, room));
  std::copy_n(raw.data, frame.length, frame.data.begin());
}

}  // namespace

bool is_interface_gone(int error) { return error == ENODEV || error == ENXIO; }

struct CanSocket::Control {
  bool is_from_bus = false;  ///< Only such frames must have a hardware stamp.
  std::int64_t kernel_ns = 0;
  std::int64_t hardware_ns = 0;
  std::optional<std::uint32_t> drops;

  /// The driver makes error frames; frames sent on this computer never were in the controller.
  Control(msghdr& header, canid_t id)
      : is_from_bus((id & CAN_ERR_FLAG) == 0 && (header.msg_flags & MSG_DONTROUTE) == 0) {
    for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
      if (c->cmsg_level == SOL_SOCKET) {
        take(*c);
      }
    }
  }

  void take(cmsghdr& c) {
    if (c.cmsg_type == SO_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(&c), sizeof(time));
      kernel_ns = ns_of(time);
    } else if (c.cmsg_type == SO_TIMESTAMPING) {
      scm_timestamping times{};
      std::memcpy(&times, CMSG_DATA(&c), sizeof(times));
      hardware_ns = ns_of(times.ts[2]);
    } else if (c.cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t count = 0;
      std::memcpy(&count, CMSG_DATA(&c), sizeof(count));
      drops = count;
    }
  }
};

void CanSocket::close() {
  descriptor_ = Descriptor();
  interface_index_ = 0;
}

CanOpenResult CanSocket::fail() {
  const int error = errno;
  close();
  return {error};
}

CanOpenResult CanSocket::open(unsigned interface_index, const IdSet& ids,
                              const CanSocketOptions& options) {
  close();
  descriptor_ = Descriptor(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  if (!is_open()) {
    return fail();
  }
  interface_index_ = interface_index;
  if (interface_index == 0) {
    errno = ENODEV;
    return fail();
  }
  constexpr int kOn = 1;
  constexpr can_err_mask_t kAllErrors = CAN_ERR_MASK;
  // Without CAN_RAW_FD_FRAMES FD frames would be dropped silently.
  if (!set_filters(descriptor(), ids) ||
      !set_option(descriptor(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kAllErrors) ||
      !set_option(descriptor(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, kOn)) {
    return fail();
  }
  const CanOpenResult result = configure(options);
  return result.error == 0 && !bind_to(descriptor(), interface_index_) ? fail() : result;
}

bool CanSocket::set_ids(const IdSet& ids) { return set_filters(descriptor(), ids); }

CanOpenResult CanSocket::adopt(int descriptor, const CanSocketOptions& options) {
  close();
  descriptor_ = Descriptor(descriptor);
  return configure(options);
}

CanOpenResult CanSocket::configure(const CanSocketOptions& options) {
  constexpr int kOn = 1;
  constexpr int kHardwareStamps = SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  hardware_stamps_ = options.hardware_stamps;
  hardware_stamps_work_ = true;
  last_hardware_ns_ = 0;
  kernel_drops_ = 0;
  // SO_TIMESTAMPNS stamps every frame; SO_TIMESTAMPING may not.
  if (!set_option(descriptor(), SOL_SOCKET, SO_TIMESTAMPNS, kOn) ||
      (hardware_stamps_ &&
       !set_option(descriptor(), SOL_SOCKET, SO_TIMESTAMPING, kHardwareStamps)) ||
      !set_option(descriptor(), SOL_SOCKET, SO_RXQ_OVFL, kOn)) {
    return fail();
  }
  return {0, granted_buffer_bytes(descriptor(), options.receive_buffer_bytes)};
}

CanReceiveResult CanSocket::receive() {
  constexpr std::size_t kControlBytes = CMSG_SPACE(sizeof(timespec)) +
                                        CMSG_SPACE(sizeof(scm_timestamping)) +
                                        CMSG_SPACE(sizeof(std::uint32_t));
  struct alignas(cmsghdr) ControlBuffer {
    std::array<char, kControlBytes> bytes;
  };
  std::array<canfd_frame, kBatchFrames> raw;
  std::array<ControlBuffer, kBatchFrames> control;
  std::array<iovec, kBatchFrames> vectors{};
  std::array<mmsghdr, kBatchFrames> headers{};
  for (std::size_t i = 0; i < kBatchFrames; ++i) {
    vectors[i] = {&raw[i], sizeof(canfd_frame)};
    headers[i].msg_hdr.msg_iov = &vectors[i];
    headers[i].msg_hdr.msg_iovlen = 1;
    headers[i].msg_hdr.msg_control = &control[i];
    headers[i].msg_hdr.msg_controllen = kControlBytes;
  }
  const int count =
      ::recvmmsg(descriptor(), headers.data(), kBatchFrames, MSG_DONTWAIT, /*timeout=*/nullptr);
  if (count < 0) {
    return {errno == EAGAIN || errno == EINTR ? 0 : errno, {}};
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t size = headers[i].msg_len;
    const bool is_cut = (headers[i].msg_hdr.msg_flags & MSG_TRUNC) != 0;
    if (is_cut || (size != CAN_MTU && size != CANFD_MTU)) {
      continue;
    }
    const Control said(headers[i].msg_hdr, raw[i].can_id);
    fill(raw[i], size, batch_[kept].frame);
    batch_[kept].frame.stamp_us = stamp_us(said);
    batch_[kept].received_us = said.kernel_ns / 1000;
    batch_[kept].lost_before = lost_before(said);
    ++kept;
  }
  return {0, std::span(batch_).first(kept)};
}

std::int64_t CanSocket::stamp_us(const Control& control) {
  const bool may_lack_it = control.hardware_ns == 0 && !control.is_from_bus;
  if (!hardware_stamps_ || !hardware_stamps_work_ || may_lack_it) {
    return control.kernel_ns / 1000;
  }
  const std::int64_t difference_ns = control.hardware_ns - control.kernel_ns;
  hardware_stamps_work_ = control.hardware_ns != 0 && control.hardware_ns >= last_hardware_ns_ &&
                          difference_ns > -kMaxClockDifferenceNs &&
                          difference_ns < kMaxClockDifferenceNs;
  last_hardware_ns_ = control.hardware_ns;
  return (hardware_stamps_work_ ? control.hardware_ns : control.kernel_ns) / 1000;
}

std::uint32_t CanSocket::lost_before(const Control& control) {
  const std::uint32_t before = kernel_drops_;
  kernel_drops_ = control.drops.value_or(before);
  return kernel_drops_ - before;
}

int CanSocket::send(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = std::min<std::uint8_t>(frame.length, CAN_MAX_DLEN);
  std::copy_n(frame.data.begin(), raw.can_dlc, raw.data);
  const ssize_t sent = ::send(descriptor(), &raw, sizeof(raw), MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(sizeof(raw)) ? 0 : errno;
}

}  // namespace cremed
