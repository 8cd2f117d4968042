// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_filters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <span>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

/// A criterion for clusters; its code is its index in the table.
struct Row {
  std::string_view name;
  std::string_view unit;
  double per_unit;  ///< Units shown per SI unit.
};

constexpr std::array<Row, 6> kRows{{{"count", "", 1.0},
                                    {"range", " m", 1.0},
                                    {"azimuth", " deg", kDegPerRad},
                                    {"oncoming", " m/s", 1.0},
                                    {"departing", " m/s", 1.0},
                                    {"rcs", " dBm^2", 1.0}}};

std::optional<double> parse_number(std::string_view text) {
  const auto value = whole_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// The content of a 0x202 or 0x204.
std::optional<Ars408FilterState> filter_in(const CanFrame& frame) {
  return decode_ars408<Ars408FilterState>(std::span(frame.data).first(frame.length));
}

/// Rounds to steps of the frame; limits need no rounding.
bool can_be_sent(const Ars408FilterState& filter) {
  const auto& limits = ars408_signals::kFilterLimits[static_cast<std::size_t>(filter.criterion)];
  const double step = 1.0 / limits.scale.steps_per_unit;
  const auto sent = filter_in(encode_ars408_filter(0, filter));
  return sent && std::abs(sent->min - filter.min) <= step &&
         std::abs(sent->max - filter.max) <= step;
}

bool set_limits(std::string_view text, double per_unit, Ars408FilterState& filter) {
  const std::size_t dots = text.find("..");
  const auto min = parse_number(text.substr(0, dots));
  const auto max =
      dots == std::string_view::npos ? std::nullopt : parse_number(text.substr(dots + 2));
  if (!min || !max || *min > *max) {
    return false;
  }
  filter.active = true;
  filter.min = *min / per_unit;
  filter.max = *max / per_unit;
  return can_be_sent(filter);
}

std::string shown(double value, const Row& row) {
  constexpr double kDigits = 100.0;
  return digits(std::round(value * row.per_unit * kDigits) / kDigits);
}

std::vector<CanFrame> frames_to_send(std::uint8_t sensor_id,
                                     const std::vector<Ars408FilterState>& wanted) {
  std::vector<CanFrame> frames;
  frames.reserve(std::max(wanted.size(), kRows.size()));
  for (const Ars408FilterState& filter : wanted) {
    frames.push_back(encode_ars408_filter(sensor_id, filter));
  }
  for (std::size_t i = 0; wanted.empty() && i < kRows.size(); ++i) {
    frames.push_back(encode_ars408_filter_query(sensor_id, false, static_cast<Ars408Criterion>(i)));
  }
  return frames;
}

/// The sensor's answer to a 0x202: the 0x204 of the same filter.
std::optional<Ars408FilterState> answer_to(const CanFrame& sent, const Ars408Talk& talk) {
  const std::uint32_t id =
      ars408_id(static_cast<std::uint32_t>(Ars408Message::filter_state), ars408_sensor_id(sent.id));
  const auto asked = filter_in(sent);
  std::optional<Ars408FilterState> answer;
  listen(talk.socket, talk.options.confirm_us, [&](const CanFrame& frame) {
    const auto filter = frame.is_classic_data() && frame.id == id ? filter_in(frame) : std::nullopt;
    if (filter && !filter->for_objects && filter->criterion == asked->criterion) {
      answer = filter;
    }
    return answer.has_value();
  });
  return answer;
}

/// Sends one frame and prints the answer; `wanted`: the expected filter.
bool exchange(const CanFrame& frame, const std::optional<Ars408FilterState>& wanted,
              const Ars408Talk& talk) {
  if (!send(talk, frame)) {
    return false;
  }
  const auto answer = answer_to(frame, talk);
  if (!answer) {
    talk.out << "no 0x204 came after it: the sensor does not answer\n";
    return false;
  }
  const bool took = !wanted || to_text(*wanted) == to_text(*answer);
  talk.out << "  " << to_text(*answer)
           << (!wanted ? ""
               : took  ? ", set"
                       : ", not set: expected " + to_text(*wanted))
           << '\n';
  return took;
}

/// After a failure: what was set before it stays.
void tell_written(std::span<const Ars408FilterState> written, std::ostream& out) {
  if (!written.empty()) {
    const auto text = [](const Ars408FilterState& filter) { return to_text(filter); };
    out << "already in its flash: " << joined(written, text, "; ") << '\n';
  }
}

}  // namespace

std::optional<Ars408FilterState> parse_ars408_filter(std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  const auto row = std::ranges::find(kRows, name, &Row::name);
  if (row == kRows.end() || equals == std::string_view::npos) {
    return std::nullopt;
  }
  Ars408FilterState filter;
  filter.criterion = static_cast<Ars408Criterion>(row - kRows.begin());
  const std::string_view value = text.substr(equals + 1);
  return value == "off" || set_limits(value, row->per_unit, filter) ? std::optional(filter)
                                                                    : std::nullopt;
}

std::string to_text(const Ars408FilterState& filter) {
  const auto index = static_cast<std::size_t>(filter.criterion);
  const Row& row = kRows[index % kRows.size()];
  if (!filter.active) {
    return concat({row.name, ": off"});
  }
  return concat({row.name, ": ", shown(filter.min, row), " to ", shown(filter.max, row), row.unit});
}

TalkResult talk_about_filters(const Ars408Talk& talk,
                              const std::vector<Ars408FilterState>& wanted) {
  const auto met = meet(talk);
  if (!met) {
    return TalkResult::not_sent;
  }
  talk.out << (wanted.empty() ? "It sends its filters on request; this changes no setting.\n"
                              : "The sensor keeps filters in its flash, which wears.\n");
  const std::vector<CanFrame> frames = frames_to_send(met->sensor_id, wanted);
  if (!is_agreed(talk, frames)) {
    return TalkResult::not_sent;
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto expected = wanted.empty() ? std::nullopt : filter_in(frames[i]);
    if (!exchange(frames[i], expected, talk)) {
      tell_written(std::span(wanted).first(std::min(i, wanted.size())), talk.out);
      return TalkResult::not_taken;
    }
  }
  return TalkResult::took;
}

}  // namespace cremed
