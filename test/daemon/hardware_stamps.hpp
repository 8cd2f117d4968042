// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Replaces recvmmsg(2) in the test that includes it: datagrams get the stamps of a CAN controller.

#include <cstdint>
#include <cstring>
#include <ctime>
#include <optional>

#include <linux/errqueue.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace cremed::test {

/// The controller's clock, ahead of the kernel's stamps; nothing: it has no stamps.
inline std::optional<std::int64_t> hardware_ahead_us;

/// Behind what the kernel tells of a datagram; the caller has room.
inline void add_hardware_stamp(msghdr& header) {
  timespec kernel{};
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_TIMESTAMPNS) {
      std::memcpy(&kernel, CMSG_DATA(c), sizeof(kernel));
    }
  }
  const std::int64_t ns =
      kernel.tv_sec * 1'000'000'000 + kernel.tv_nsec + *hardware_ahead_us * 1000;
  scm_timestamping times{};
  times.ts[2] = {ns / 1'000'000'000, ns % 1'000'000'000};
  auto* const added =
      reinterpret_cast<cmsghdr*>(static_cast<char*>(header.msg_control) + header.msg_controllen);
  added->cmsg_len = CMSG_LEN(sizeof(times));
  added->cmsg_level = SOL_SOCKET;
  added->cmsg_type = SO_TIMESTAMPING;
  std::memcpy(CMSG_DATA(added), &times, sizeof(times));
  header.msg_controllen += CMSG_SPACE(sizeof(times));
}

}  // namespace cremed::test

extern "C" int recvmmsg(int descriptor, mmsghdr* headers, unsigned count, int flags,
                        timespec* timeout) {
  const auto received =
      static_cast<int>(::syscall(SYS_recvmmsg, descriptor, headers, count, flags, timeout));
  for (int i = 0; i < received && cremed::test::hardware_ahead_us; ++i) {
    cremed::test::add_hardware_stamp(headers[i].msg_hdr);
  }
  return received;
}
