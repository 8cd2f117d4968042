// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/bit_field.hpp"
#include "daemon/source/can_socket.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace cremed::test {

/// The state of a sensor that is set as expected.
inline Ars408RadarState good_state(std::uint8_t sensor_id = 0) {
  Ars408RadarState state;
  state.nvm_read = true;
  state.max_distance_m = 200.0;
  state.sensor_id = sensor_id;
  state.sends_quality = true;
  state.output_code = 2;
  return state;
}

/// Reaction of the sensor to a RadarCfg.
struct Ars408Manners {
  bool obeys = true;
  bool keeps_range = false;   ///< A model with a shorter range than commanded.
  bool falls_silent = false;  ///< Sends no 0x201 after a command.
  int filters_taken = 1000;   ///< It obeys that many, and then no more.
};

/// Sensors at the other end of a socket that replaces a bus: each reports its state about a hundred
/// times as often as a real one, and obeys 0x200 + 0x10 * its own id.
class FakeArs408s {
 public:
  /// `traffic` of other nodes is sent with each report.
  FakeArs408s(std::vector<Ars408RadarState> states, Ars408Manners manners,
              std::vector<CanFrame> traffic)
      : states_(std::move(states)), manners_(manners), traffic_(std::move(traffic)) {
    std::array<int, 2> ends{};
    // Holds more than the ten messages of SOCK_DGRAM.
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw std::runtime_error("socketpair failed");
    }
    bus_ = ends[0];
    if (socket_.adopt(ends[1], {}).error != 0) {
      throw std::runtime_error("adopt failed");
    }
    report();  // The first report is available at once on a busy computer too.
    thread_ = std::thread([this] { live(); });
  }
  ~FakeArs408s() {
    stop();
    ::close(bus_);
  }
  FakeArs408s(const FakeArs408s&) = delete;
  FakeArs408s& operator=(const FakeArs408s&) = delete;

  CanSocket& socket() { return socket_; }

  void send(const CanFrame& frame) const {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.can_dlc = frame.length;
    std::memcpy(raw.data, frame.data.data(), sizeof(raw.data));
    ::send(bus_, &raw, sizeof(raw), MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  /// All frames sent to the bus; stops the sensors.
  const std::vector<CanFrame>& all_received() {
    stop();
    while (hear(0)) {
    }
    return received_;
  }

 private:
  void live() {
    constexpr int kPeriodMs = 4;
    while (!stop_) {
      report();
      hear(kPeriodMs);
    }
  }

  void stop() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  /// Receives a frame within the time-out.
  bool hear(int wait_ms) {
    pollfd polled{bus_, POLLIN, 0};
    can_frame raw{};
    const bool is_heard =
        ::poll(&polled, 1, wait_ms) > 0 && ::read(bus_, &raw, sizeof(raw)) == sizeof(raw);
    if (is_heard) {
      take(raw);
    }
    return is_heard;
  }

  void report() {
    for (const Ars408RadarState& state : states_) {
      if (!silent_) {
        send(encode_ars408(state.sensor_id, state));
      }
    }
    for (const CanFrame& frame : traffic_) {
      send(frame);
    }
  }

  void take(const can_frame& raw) {
    CanFrame frame;
    frame.id = raw.can_id;
    frame.length = raw.can_dlc;
    std::memcpy(frame.data.data(), raw.data, sizeof(raw.data));
    received_.push_back(frame);
    silent_ = silent_ || manners_.falls_silent;
    for (Ars408RadarState& state : states_) {
      const std::uint32_t own = 0x10U * state.sensor_id;
      if (frame.id == 0x200U + own && manners_.obeys) {
        obey(PayloadBits::big_endian(std::span(frame.data).first(8)), state);
      } else if (frame.id == 0x202U + own && !silent_) {
        answer(frame);
      }
    }
  }

  /// Sets a filter if its valid bit is set, and always answers with the filter's state.
  void answer(const CanFrame& asked) {
    const auto filter = decode_ars408<Ars408FilterState>(std::span(asked.data).first(asked.length));
    const auto index = static_cast<std::size_t>(filter->criterion);
    const bool is_valid = (asked.data[0] & 2U) != 0;
    if (is_valid && manners_.obeys && manners_.filters_taken-- > 0) {
      filters_[index] = asked;
    }
    CanFrame told = filters_[index];
    told.id = asked.id + 2U;
    told.length = 5;
    told.data[0] = static_cast<std::uint8_t>((told.data[0] & ~0x7AU) | index << 3U);
    send(told);
  }

  void obey(const PayloadBits& bits, Ars408RadarState& state) const {
    if (bits.flag(0) && !manners_.keeps_range) {
      state.max_distance_m = 2.0 * static_cast<double>(bits.get({22, 10}));
    }
    const SignalReader signal(bits);
    if (bits.flag(1)) signal({32, 3}, state.sensor_id);
    if (bits.flag(3)) signal({35, 2}, state.output_code);
    if (bits.flag(4)) signal({42, 1}, state.sends_quality);
    if (bits.flag(5)) signal({43, 1}, state.sends_extended);
    if (bits.flag(7)) signal({47, 1}, state.nvm_written);
  }

  std::vector<Ars408RadarState> states_;
  Ars408Manners manners_;
  std::vector<CanFrame> traffic_;
  CanSocket socket_;
  int bus_ = -1;
  std::atomic<bool> stop_ = false;
  bool silent_ = false;
  std::array<CanFrame, 16> filters_{};
  std::vector<CanFrame> received_;
  std::thread thread_;
};

}  // namespace cremed::test
