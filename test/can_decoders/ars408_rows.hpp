// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "test/can_decoders/signal_values.hpp"

namespace cremed::test {

/// A frame and its decoded values.
template <class Message>
struct Ars408Row {
  std::string frame;
  Message expected;
};

constexpr double deg(double degrees) { return degrees * std::numbers::pi / 180.0; }

inline const Ars408MessageRow& message_of(const CanFrame& frame) {
  const auto* row = std::ranges::find_if(kArs408Messages, [&](const auto& m) {
    return static_cast<std::uint32_t>(m.message) == (frame.id & ~0x70U);
  });
  REQUIRE(row != kArs408Messages.end());
  return *row;
}

/// Only the decoder with the frame's sensor id and mode accepts it.
inline void check_sensor(const CanFrame& frame, Ars408Subject subject) {
  const auto output =
      subject == Ars408Subject::objects ? Ars408Output::objects : Ars408Output::clusters;
  for (std::uint8_t sensor = 0; sensor < 8; ++sensor) {
    Ars408Decoder decoder({.sensor_id = sensor, .output = output});
    const ScanPart part = decoder.decode(frame);
    const bool ours = sensor == (frame.id >> 4U & 7U);
    const DecoderCounters& counters = decoder.counters();
    CHECK(counters.frames == (ours ? 1 : 0));
    CHECK(counters.wrong_length + counters.wrong_kind + counters.wrong_mode == 0);
    CHECK(counters.state_frames == (ours && part.kind == ScanPart::Kind::none ? 1 : 0));
  }
}

template <class Content, class Message = Content>
void check_rows(const std::vector<Ars408Row<Message>>& rows) {
  for (const auto& row : rows) {
    INFO(row.frame);
    const CanFrame frame = hex_frame(row.frame);
    const Ars408MessageRow& message = message_of(frame);
    const std::optional<Message> decoded = decode_ars408<Content>(bytes_of(frame));
    REQUIRE(decoded.has_value());
    CHECK(differences(*decoded, row.expected) == "");
    CHECK_FALSE(decode_ars408<Content>(bytes_of(frame).first(message.length - 1U)).has_value());
    auto longer = frame.data;
    std::fill(longer.begin() + 8, longer.end(), std::uint8_t{0xFF});
    const std::optional<Message> of_longer = decode_ars408<Content>(longer);
    CHECK(differences(of_longer.value(), row.expected) == "");
    check_sensor(frame, message.subject);
  }
}

}  // namespace cremed::test
