// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "can_decoders/ars408_layout.hpp"
#include "can_decoders/ars408_messages.hpp"
#include "daemon/can_socket.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace cremed::test {

/// How the sensor deals with a RadarCfg.
struct Ars408Manners {
  bool obeys = true;
  bool keeps_range = false;   ///< A model that cannot see as far as it is told.
  bool falls_silent = false;  ///< No 0x201 any more after a command.
};

/// Sensors at the other end of a socket that stands for a bus: each reports its state, some hundred
/// times as often as a real one, and obeys 0x200 + 0x10 * its own id.
class FakeArs408s {
 public:
  /// `traffic` of others is sent along with each report.
  FakeArs408s(std::vector<Ars408RadarState> states, Ars408Manners manners,
              std::vector<CanFrame> traffic)
      : states_(std::move(states)), manners_(manners), traffic_(std::move(traffic)) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw std::runtime_error("socketpair failed");
    }
    bus_ = ends[0];
    if (socket_.adopt(ends[1], {}).status != CanOpenStatus::open) {
      throw std::runtime_error("adopt failed");
    }
    thread_ = std::thread([this] { live(); });
  }
  ~FakeArs408s() {
    stop_ = true;
    thread_.join();
    ::close(bus_);
  }
  FakeArs408s(const FakeArs408s&) = delete;
  FakeArs408s& operator=(const FakeArs408s&) = delete;

  CanSocket& socket() { return socket_; }

  /// Frames that were sent to the bus.
  std::vector<CanFrame> received() {
    const std::lock_guard lock(mutex_);
    return received_;
  }

 private:
  void live() {
    constexpr int kPeriodMs = 4;
    while (!stop_) {
      report();
      pollfd polled{bus_, POLLIN, 0};
      can_frame raw{};
      if (::poll(&polled, 1, kPeriodMs) > 0 && ::read(bus_, &raw, sizeof(raw)) == sizeof(raw)) {
        take(raw);
      }
    }
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

  void send(const CanFrame& frame) const {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.can_dlc = frame.length;
    std::memcpy(raw.data, frame.data.data(), sizeof(raw.data));
    ::send(bus_, &raw, sizeof(raw), MSG_DONTWAIT);
  }

  void take(const can_frame& raw) {
    CanFrame frame;
    frame.id = raw.can_id;
    frame.length = raw.can_dlc;
    std::memcpy(frame.data.data(), raw.data, sizeof(raw.data));
    {
      const std::lock_guard lock(mutex_);
      received_.push_back(frame);
    }
    for (Ars408RadarState& state : states_) {
      if (manners_.obeys && frame.id == 0x200U + 0x10U * state.sensor_id) {
        obey(PayloadBits::big_endian(std::span(frame.data).first(8)), state);
        break;
      }
    }
    silent_ = manners_.falls_silent;
  }

  void obey(const PayloadBits& bits, Ars408RadarState& state) const {
    using namespace ars408_layout::configuration;
    if (bits.flag(kMaxDistanceValid) && !manners_.keeps_range) {
      state.max_distance_m = kMaxDistanceScale(bits.get(kMaxDistance));
    }
    if (bits.flag(kSensorIdValid)) state.sensor_id = bits.get8(kSensorId);
    if (bits.flag(kOutputValid)) state.output_code = bits.get8(kOutput);
    if (bits.flag(kSendsQualityValid)) state.sends_quality = bits.get(kSendsQuality) != 0;
    if (bits.flag(kSendsExtendedValid)) state.sends_extended = bits.get(kSendsExtended) != 0;
    if (bits.flag(kStoreValid)) state.nvm_written = bits.get(kStore) != 0;
  }

  std::vector<Ars408RadarState> states_;
  Ars408Manners manners_;
  std::vector<CanFrame> traffic_;
  CanSocket socket_;
  int bus_ = -1;
  std::atomic<bool> stop_ = false;
  bool silent_ = false;
  std::mutex mutex_;
  std::vector<CanFrame> received_;
  std::thread thread_;
};

}  // namespace cremed::test
