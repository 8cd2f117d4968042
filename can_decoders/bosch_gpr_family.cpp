// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <string_view>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/hexadecimal.hpp"
#include "cremed/can_decoders/radar_family.hpp"

namespace cremed {
namespace {

constexpr std::array<std::string_view, 3> kCrcPolicies = {"off", "count", "enforce"};
constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::uint8_t kLength = 8;
constexpr std::string_view kInvertAzimuth = "invert_azimuth";
constexpr std::string_view kInvertDoppler = "invert_doppler";

void check_ids(OptionReader& reader, const BoschGprOptions& options) {
  if (reader.clean() && options.info_id >= options.base_id &&
      options.info_id < options.base_id + kGprTargetIds) {
    reader.report(
        reader.has("info_id") ? "info_id" : "base_id",
        "makes info_id one of the targets' identifiers; must be outside base_id to base_id + 95");
  }
}

RadarSettings read(OptionReader& reader) {
  BoschGprOptions options;
  reader.identifier("base_id", options.base_id, kMaxStandardId + 1 - kGprTargetIds);
  reader.identifier("info_id", options.info_id, kMaxStandardId);
  if (const auto policy = reader.choice("crc_policy", kCrcPolicies)) {
    options.crc_policy = static_cast<CrcPolicy>(*policy);
  }
  reader.boolean(kInvertAzimuth, options.invert_azimuth);
  reader.boolean(kInvertDoppler, options.invert_doppler);
  reader.number("min_existence", options.min_existence, {0.0, 0.96875});
  check_ids(reader, options);
  return options;
}

std::unique_ptr<RadarDecoder> make_decoder(const BoschGprOptions& options) {
  return std::make_unique<BoschGprDecoder>(options);
}

IdSet sent_ids(const BoschGprOptions& options) {
  IdSet ids;
  ids.set(options.info_id);
  for (std::uint32_t i = 0; i < kGprTargetIds; ++i) {
    ids.set(options.base_id + i);
  }
  return ids;
}

std::string label(const BoschGprOptions& /*options*/) { return "Bosch GPR"; }

std::string describe(const BoschGprOptions& options) {
  return "a Bosch GPR with base id " + hexadecimal(options.base_id);
}

std::string key(const BoschGprOptions& options) {
  return "base_id = " + hexadecimal(options.base_id);
}

/// A GPR is a run of kGprTargetIds consecutive identifiers with its frame length.
std::vector<RadarSettings> recognise(const BusTraffic& bus, IdSet& unexplained) {
  std::vector<RadarSettings> radars;
  std::uint32_t run = 0;
  for (std::uint32_t id = 0; id < bus.ids.size(); ++id) {
    run = unexplained[id] && bus.ids[id].length == kLength ? run + 1 : 0;
    if (run == kGprTargetIds) {
      const std::uint32_t base_id = id + 1 - kGprTargetIds;
      radars.emplace_back(BoschGprOptions{.base_id = base_id});
      for (std::uint32_t explained = base_id; explained <= id; ++explained) {
        unexplained.reset(explained);
      }
      run = 0;
    }
  }
  return radars;
}

}  // namespace

const RadarFamily& family_of(const BoschGprOptions& /*options*/) {
  static constexpr RadarFamily kBoschGpr{.type = "bosch_gpr",
                                         .read = read,
                                         .make_decoder = kOfSettings<make_decoder>,
                                         .sent_ids = kOfSettings<sent_ids>,
                                         .label = kOfSettings<label>,
                                         .describe = kOfSettings<describe>,
                                         .key = kOfSettings<key>,
                                         .recognise = recognise,
                                         .azimuth_sign_key = kInvertAzimuth,
                                         .doppler_sign_key = kInvertDoppler};
  return kBoschGpr;
}

}  // namespace cremed
