// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// UDP on this computer replaces CAN, which test machines may lack: it has the same stamps and drop
// counts. CAN's own features (filters, interfaces) are tested in test/vm.
#include <array>
#include <cerrno>
#include <vector>

#include <catch2/catch.hpp>
#include <linux/can.h>

#include "daemon/process/clocks.hpp"
#include "daemon/source/can_socket.hpp"
#include "test/daemon/datagram_pair.hpp"
#include "test/daemon/hardware_stamps.hpp"

using namespace cremed;
using cremed::test::DatagramPair;

namespace {

constexpr std::int64_t kRecentUs = 1'000'000;

/// All available frames.
std::vector<ReceivedFrame> receive_all(CanSocket& socket) {
  std::vector<ReceivedFrame> all;
  for (;;) {
    const CanReceiveResult result = socket.receive();
    if (result.frames.empty()) {
      CHECK(result.error == 0);
      return all;
    }
    CHECK(result.frames.size() <= CanSocket::kBatchFrames);
    all.insert(all.end(), result.frames.begin(), result.frames.end());
  }
}

}  // namespace

TEST_CASE("Identifier, kind, length and bytes are those of the frame; bytes past them are zero") {
  const DatagramPair pair;
  CanSocket socket;
  REQUIRE(socket.adopt(pair.receiver(), {}).error == 0);
  pair.send(0x701, 8);
  pair.send(0x702, 5);
  pair.send(0x12345678 | CAN_EFF_FLAG, 3);
  pair.send(0x123 | CAN_RTR_FLAG, 8);
  pair.send(0x40 | CAN_ERR_FLAG, 8);
  canfd_frame fd{};
  fd.can_id = 0x55;
  fd.len = 64;
  fd.data[63] = 7;
  pair.send(&fd, sizeof(fd));

  const auto frames = receive_all(socket);
  REQUIRE(frames.size() == 6);
  CHECK(frames[0].frame.id == 0x701);
  CHECK(frames[0].frame.is_classic_data());
  CHECK(frames[0].frame.data[7] == 0xAB);
  CHECK(frames[0].frame.data[8] == 0);
  CHECK(frames[1].frame.length == 5);
  CHECK(frames[1].frame.data[4] == 0xAB);
  CHECK(frames[1].frame.data[5] == 0);
  CHECK(frames[2].frame.extended);
  CHECK(frames[2].frame.id == 0x12345678);
  CHECK(frames[3].frame.remote);
  CHECK(frames[3].frame.id == 0x123);
  CHECK(frames[4].frame.error);
  CHECK(frames[4].frame.id == 0x40);
  CHECK(frames[5].frame.fd);
  CHECK(frames[5].frame.length == 64);
  CHECK(frames[5].frame.data[63] == 7);
}

TEST_CASE("Stamps are the kernel's receive time, in order") {
  const DatagramPair pair;
  CanSocket socket;
  REQUIRE(socket.adopt(pair.receiver(), {}).error == 0);
  const std::int64_t before_us = realtime_us();
  pair.send(1, 8);
  pair.send(2, 8);
  const auto frames = receive_all(socket);
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].frame.stamp_us >= before_us);
  CHECK(frames[1].frame.stamp_us >= frames[0].frame.stamp_us);
  CHECK(frames[1].frame.stamp_us <= realtime_us());
}

TEST_CASE("Hardware stamps that a device does not have give way to the kernel's") {
  const DatagramPair pair;
  CanSocket socket;
  CanSocketOptions options;
  options.hardware_stamps = true;
  REQUIRE(socket.adopt(pair.receiver(), options).error == 0);
  CHECK(socket.hardware_stamps_work());
  pair.send(0x40 | CAN_ERR_FLAG, 8);  // No device has one for what its driver makes.
  const auto errors = receive_all(socket);
  REQUIRE(errors.size() == 1);
  CHECK(std::abs(errors[0].frame.stamp_us - realtime_us()) < kRecentUs);
  CHECK(socket.hardware_stamps_work());
  pair.send(1, 8);
  const auto frames = receive_all(socket);
  REQUIRE(frames.size() == 1);
  CHECK_FALSE(socket.hardware_stamps_work());
  CHECK(std::abs(frames[0].frame.stamp_us - realtime_us()) < kRecentUs);
}

TEST_CASE("Hardware stamps are used until one is 20 ms off the kernel's") {
  const auto [ahead_us, works] = GENERATE(table<std::int64_t, bool>(
      {{-15'000, true}, {15'000, true}, {-25'000, false}, {25'000, false}, {-700'000, false}}));
  const DatagramPair pair;
  CanSocket socket;
  CanSocketOptions options;
  options.hardware_stamps = true;
  REQUIRE(socket.adopt(pair.receiver(), options).error == 0);
  const auto stamp_ahead_us = [&](std::int64_t hardware_ahead_us) {
    test::hardware_ahead_us = hardware_ahead_us;
    pair.send(1, 8);
    const auto frames = receive_all(socket);
    test::hardware_ahead_us.reset();
    REQUIRE(frames.size() == 1);
    return frames[0].frame.stamp_us - frames[0].received_us;
  };
  CHECK(stamp_ahead_us(ahead_us) == (works ? ahead_us : 0));
  CHECK(socket.hardware_stamps_work() == works);
  CHECK((works || stamp_ahead_us(1000) == 0));
}

TEST_CASE("Frames that the kernel drops are told with the next that it keeps, and told once") {
  constexpr std::size_t kSent = 3000;
  const DatagramPair pair;
  CanSocket socket;
  CanSocketOptions options;
  options.receive_buffer_bytes = 1 << 16;
  REQUIRE(socket.adopt(pair.receiver(), options).error == 0);
  for (std::size_t i = 0; i < kSent; ++i) {
    pair.send(1, 8);
  }
  const std::size_t kept = receive_all(socket).size();
  REQUIRE(kept < kSent);
  pair.send(2, 8);
  pair.send(3, 8);
  const auto frames = receive_all(socket);
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].lost_before == kSent - kept);
  CHECK(frames[1].lost_before == 0);
}

TEST_CASE("A burst comes in batches, whole and in order") {
  const DatagramPair pair;
  CanSocket socket;
  REQUIRE(socket.adopt(pair.receiver(), {}).error == 0);
  for (canid_t id = 0; id < 200; ++id) {
    pair.send(id, 8);
  }
  CHECK(socket.receive().frames.size() == CanSocket::kBatchFrames);
  const auto rest = receive_all(socket);
  REQUIRE(rest.size() == 200 - CanSocket::kBatchFrames);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    CHECK(rest[i].frame.id == i + CanSocket::kBatchFrames);
  }
}

TEST_CASE("What is no frame is passed over") {
  const DatagramPair pair;
  CanSocket socket;
  REQUIRE(socket.adopt(pair.receiver(), {}).error == 0);
  const std::array<char, 100> junk{};
  pair.send(junk.data(), 3);
  pair.send(junk.data(), junk.size());
  pair.send(9, 8);
  const auto frames = receive_all(socket);
  REQUIRE(frames.size() == 1);
  CHECK(frames[0].frame.id == 9);
}

TEST_CASE("The granted receive buffer is read back") {
  const DatagramPair pair;
  CanSocket socket;
  CanSocketOptions options;
  options.receive_buffer_bytes = 1 << 16;
  CHECK(socket.adopt(pair.receiver(), options).receive_buffer_bytes == 1 << 16);
}

TEST_CASE("An interface that does not exist is said to be missing, not a failure") {
  const unsigned index = GENERATE(0U, 0x7FFFFFFFU);
  CanSocket socket;
  const CanOpenResult result = socket.open(index, {}, {});
  CHECK_FALSE(socket.is_open());
  CHECK(result.error != 0);
  CHECK((is_interface_gone(result.error) ||
         result.error == EAFNOSUPPORT ||  // No CAN in the kernel.
         result.error == EPROTONOSUPPORT));
  CHECK(socket.send(CanFrame{}) == EBADF);
}
