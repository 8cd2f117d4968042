// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/diagnosis_json.hpp"

#include <cstddef>

#include <nlohmann/json.hpp>

#include "daemon/process/plain_text.hpp"
#include "daemon/report/report.hpp"
#include "tools/doctor/diagnosis.hpp"

namespace cremed {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Finding& finding) {
  return {{"severity", severity_name(finding.severity)},
          {"what", plain_text(finding.what)},
          {"remedy", plain_text(finding.remedy)}};
}

Json to_json(const RadarConfiguration& radar, const RadarObservation& observed) {
  return {{"radar", radar.name},
          {"interface", radar.interface},
          {"frames", observed.status.decoder.frames},
          {"scans", observed.status.assembler.scans},
          {"incomplete_scans", observed.status.assembler.incomplete_scans},
          {"estimates", estimates(observed.status)},
          {"longest_pause_s", observed.times.longest_pause_s}};
}

}  // namespace

std::string diagnosis_json(const Configuration& configuration, const Observation& observation,
                           const std::vector<Finding>& findings) {
  Json json{{"good", is_well(findings)},
            {"seconds", observation.seconds},
            {"findings", Json::array()},
            {"radars", Json::array()}};
  for (const Finding& finding : findings) {
    json["findings"].push_back(to_json(finding));
  }
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    json["radars"].push_back(to_json(configuration.radars[i], observation.radars[i]));
  }
  return json.dump(2);
}

}  // namespace cremed
