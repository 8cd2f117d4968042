// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/bosch_gpr_signals.hpp"

namespace cremed::test {

/// The names in config/*.dbc of a message's signals, in the order of its signals(). A name that
/// comes again is the next bit of the same signal.
template <class Message>
inline constexpr auto kSignalNames = std::array<const char*, 0>{};
template <>
inline constexpr auto kSignalNames<Ars408ClusterStatus> =
    std::array{"NofClustersNear", "NofClustersFar", "MeasCounter", "InterfaceVersion"};
template <>
inline constexpr auto kSignalNames<Ars408ObjectStatus> =
    std::array{"NofObjects", "MeasCounter", "InterfaceVersion"};
template <>
inline constexpr auto kSignalNames<Ars408General> =
    std::array{"ID", "DistLong", "VrelLong", "VrelLat", "DynProp", "RCS", "DistLat"};
template <>
inline constexpr auto kSignalNames<Ars408Cluster> = kSignalNames<Ars408General>;
template <>
inline constexpr auto kSignalNames<Ars408Object> = kSignalNames<Ars408General>;
template <>
inline constexpr auto kSignalNames<Ars408ClusterQuality> =
    std::array{"ID",          "DistLong_rms", "DistLat_rms",  "VrelLong_rms",
               "VrelLat_rms", "Pdh0",         "InvalidState", "AmbigState"};
template <>
inline constexpr auto kSignalNames<Ars408ObjectQuality> =
    std::array{"ID",           "DistLong_rms", "DistLat_rms",     "VrelLong_rms", "VrelLat_rms",
               "ArelLong_rms", "ArelLat_rms",  "Orientation_rms", "ProbOfExist",  "MeasState"};
template <>
inline constexpr auto kSignalNames<Ars408RadarState> = std::array{
    "NVMReadStatus",     "NVMwriteStatus",  "MaxDistanceCfg", "Persistent_Error", "Interference",
    "Temperature_Error", "Temporary_Error", "Voltage_Error",  "RadarPowerCfg",    "SortIndex",
    "SensorID",          "MotionRxState",   "MotionRxState",  "SendExtInfoCfg",   "SendQualityCfg",
    "OutputTypeCfg",     "CtrlRelayCfg",    "RCS_Threshold"};
template <>
inline constexpr auto kSignalNames<Ars408Version> =
    std::array{"MajorRelease", "MinorRelease", "PatchLevel", "ExtendedRange", "CountryCode"};
template <>  // Those of the limits in the file also name their criterion.
inline constexpr auto kSignalNames<Ars408FilterState> =
    std::array{"Type", "Index", "Active", "Min", "Max"};
template <>
inline constexpr auto kSignalNames<BoschGprTargetA> =
    std::array{"AMessage", "ID", "dr", "vr", "dbPower", "phi", "measured", "MC"};
template <>
inline constexpr auto kSignalNames<BoschGprTargetB> =
    std::array{"AMessage", "ID", "phiSdv", "vrSdv", "drSdv", "pExist", "timeSinceMeas", "MC"};
template <>
inline constexpr auto kSignalNames<BoschGprInfo> = std::array{
    "SensorType", "HWTemperature", "SensorBlind", "SWFail",     "HWFail",        "CANFail",
    "ConfigFail", "DiagMode",      "DTC",         "DTCOrderId", "SensorNotSafe", "MC"};

/// Collects the members of a message and their values, in the order of its signals().
class MemberCollector {
 public:
  using Members = std::vector<std::pair<const void*, double>>;
  explicit MemberCollector(Members& members) : members_(members) {}

  void operator()(BitField, const auto& code) const {
    members_.emplace_back(&code, static_cast<double>(code));
  }
  void operator()(BitField, LinearScale, const auto& value) const {
    members_.emplace_back(&value, value);
  }

 private:
  Members& members_;
};

inline void collect(const MemberCollector& collector, const auto& message) {
  using ars408_signals::signals;
  using bosch_gpr_signals::signals;
  auto m = message;
  signals(collector, m);
}
inline void collect(const MemberCollector& collector, const Ars408General& m) {
  collect(collector, Ars408Cluster{m});  // An object's signals are in the same order.
}

using NamedValues = std::vector<std::pair<std::string, double>>;

/// Throws unless each signal has a name and a member of its own.
template <class Message>
NamedValues values_of(const Message& message) {
  constexpr auto kNames = kSignalNames<Message>;
  MemberCollector::Members members;
  collect(MemberCollector(members), message);
  std::set<const void*> distinct;
  NamedValues named;
  for (std::size_t i = 0; i < members.size(); ++i) {
    distinct.insert(members[i].first);
    named.emplace_back(kNames.at(i), members[i].second);
  }
  if (distinct.size() != kNames.size()) {
    throw std::logic_error("a signal or a member is left out");
  }
  return named;
}

/// The signals that differ by more than 1e-9; empty if none does.
template <class Message>
std::string differences(const Message& decoded, const Message& expected) {
  const NamedValues found = values_of(decoded);
  const NamedValues wanted = values_of(expected);
  std::ostringstream text;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!(std::abs(found[i].second - wanted[i].second) <= 1e-9)) {
      text << found[i].first << ": " << found[i].second << " for " << wanted[i].second << "; ";
    }
  }
  return text.str();
}

}  // namespace cremed::test
