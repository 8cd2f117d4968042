// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

#include <catch2/catch.hpp>
#include <linux/can.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cremed::test {

/// A receiving socket and a sending one connected to it.
class DatagramPair {
 public:
  DatagramPair() : sender_(make()), receiver_(make()) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof(address);
    REQUIRE(::bind(receiver_, generic, size) == 0);
    REQUIRE(::getsockname(receiver_, generic, &size) == 0);
    REQUIRE(::connect(sender_, generic, size) == 0);
  }
  ~DatagramPair() { ::close(sender_); }
  DatagramPair(const DatagramPair&) = delete;
  DatagramPair& operator=(const DatagramPair&) = delete;

  /// Transfers the ownership.
  [[nodiscard]] int receiver() const { return receiver_; }
  void send(const void* data, std::size_t size) const {
    REQUIRE(::send(sender_, data, size, 0) == static_cast<ssize_t>(size));
  }
  void send(canid_t id, std::uint8_t length) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = length;
    std::memset(frame.data, 0xAB, sizeof(frame.data));
    send(&frame, sizeof(frame));
  }

 private:
  static int make() {
    const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    REQUIRE(descriptor >= 0);
    return descriptor;
  }
  int sender_;
  int receiver_;
};

}  // namespace cremed::test
