// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/bus_traffic.hpp"
#include "cremed/can_decoders/id_set.hpp"
#include "cremed/can_decoders/option_reader.hpp"
#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/radar_settings.hpp"

namespace cremed {

/// One kind of radar as a table row. The functions that take RadarSettings accept settings of this
/// family only.
struct RadarFamily {
  std::string_view type;  ///< In the configuration: "ars408".

  /// Reads the keys of this type.
  RadarSettings (*read)(OptionReader& reader);
  std::unique_ptr<RadarDecoder> (*make_decoder)(const RadarSettings&);
  IdSet (*sent_ids)(const RadarSettings&);

  std::string (*label)(const RadarSettings&);     ///< "ARS408 3"
  std::string (*describe)(const RadarSettings&);  ///< "an ARS408 with sensor id 3"
  /// The key that distinguishes radars of this type on one bus: "sensor_id = 3".
  std::string (*key)(const RadarSettings&);

  /// Finds radars of this family on a bus by identifiers, lengths and, where needed, contents, with
  /// the options these determine. Uses identifiers in `unexplained` only and removes those of the
  /// radars found. Null: radars of this family are recognised as those of `sends_like`.
  std::vector<RadarSettings> (*recognise)(const BusTraffic& bus, IdSet& unexplained) = nullptr;

  /// The family with the same keys, identifiers and messages, and the same type of options; null:
  /// none.
  const RadarFamily* sends_like = nullptr;
  double max_range_m = 0.0;  ///< Default of limits.max_range_m; 0: that of all radars.
  /// Identifiers of commands to the radar; null: none.
  IdSet (*obeyed_ids)(const RadarSettings&) = nullptr;
  /// Default time by which the radar extrapolates positions with the yaw rate it receives
  /// (estimator/scan/rotation_lead.hpp); null: it receives none.
  double (*rotation_lead_s)(const RadarSettings&) = nullptr;
  // The keys that invert a sign of its measurements, for advice; empty: none.
  std::string_view azimuth_sign_key = {};  ///< Of a radar that is mounted upside down.
  std::string_view doppler_sign_key = {};
};

/// Adapts a function of a family's options to one of RadarSettings, for a row.
template <auto function>
struct OfSettings;
template <typename Result, typename Options, Result (*function)(const Options&)>
struct OfSettings<function> {
  static Result call(const RadarSettings& settings) { return function(*settings.as<Options>()); }
};
template <auto function>
inline constexpr auto kOfSettings = &OfSettings<function>::call;

/// Whether radars of the two families cannot be distinguished on a bus.
inline bool is_alike(const RadarFamily& a, const RadarFamily& b) {
  return (a.sends_like == nullptr ? &a : a.sends_like) ==
         (b.sends_like == nullptr ? &b : b.sends_like);
}

using RadarFamilies = std::span<const RadarFamily* const>;

/// All families. Of two that can send the same identifiers, the one with more of them comes first:
/// it is recognised first, and its identifiers are not considered again.
RadarFamilies radar_families();

/// The radars recognised on a bus.
std::vector<RadarSettings> seen_radars(const BusTraffic& bus,
                                       RadarFamilies families = radar_families());

}  // namespace cremed
