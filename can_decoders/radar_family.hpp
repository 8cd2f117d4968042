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

/// All that tells one kind of radar from others, as one row. Of the functions, those of
/// RadarSettings are asked about settings of this family only.
struct RadarFamily {
  std::string_view type;  ///< In the configuration: "ars408".

  /// Reads the keys of this type.
  RadarSettings (*read)(OptionReader& reader);
  std::unique_ptr<RadarDecoder> (*make_decoder)(const RadarSettings&);
  IdSet (*sent_ids)(const RadarSettings&);

  std::string (*label)(const RadarSettings&);     ///< "ARS408 3"
  std::string (*describe)(const RadarSettings&);  ///< "an ARS408 with sensor id 3"
  /// The key that tells radars of this type on one bus apart: "sensor_id = 3".
  std::string (*key)(const RadarSettings&);

  /// The radars of this family that identifiers, lengths and, where those do not suffice, contents
  /// on a bus give away, with the options that these tell. Looks at identifiers in `unexplained`
  /// only, and takes out those of the radars it finds.
  std::vector<RadarSettings> (*recognise)(const BusTraffic& bus, IdSet& unexplained);

  /// Frames on these are commands to it; null: nothing is.
  IdSet (*obeyed_ids)(const RadarSettings&) = nullptr;
  /// Default of how far ahead it turns positions by the yaw rate it is told
  /// (estimator/scan/rotation_lead.hpp); null: it is told none.
  double (*rotation_lead_s)(const RadarSettings&) = nullptr;
};

/// For a row: a function of a family's options as one of settings.
template <auto function>
struct OfSettings;
template <typename Result, typename Options, Result (*function)(const Options&)>
struct OfSettings<function> {
  static Result call(const RadarSettings& settings) { return function(*settings.as<Options>()); }
};
template <auto function>
inline constexpr auto kOfSettings = &OfSettings<function>::call;

using RadarFamilies = std::span<const RadarFamily* const>;

/// All there are. Of two that may send the same identifiers the one that sends more stands first:
/// it is recognised first, and what it explains is of no other radar.
RadarFamilies radar_families();

/// The radars that give themselves away on a bus.
std::vector<RadarSettings> seen_radars(const BusTraffic& bus,
                                       RadarFamilies families = radar_families());

}  // namespace cremed
