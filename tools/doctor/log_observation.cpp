// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/log_observation.hpp"

#include <stdexcept>

#include "daemon/process/joined.hpp"
#include "tools/doctor/merged_logs.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {

Observation observe_logs(const Configuration& configuration,
                         const std::vector<std::string>& paths) {
  Observer observer(configuration);
  MergedLogs logs(paths);
  while (const CandumpLine* line = logs.next()) {
    if (line->status == CandumpStatus::frame) {
      observer.add(line->interface_name, line->frame);
    } else {
      observer.add_lost(line->interface_name, line->dropped_frames);
    }
  }
  for (const CandumpReader& log : logs.readers()) {
    if (const std::string problem = log.problem(); !problem.empty()) {
      throw std::runtime_error(problem);
    }
  }
  Observation observation = observer.finish();
  bool is_empty = true;
  for (BusObservation& bus : observation.buses) {
    if (bus.status.frames + bus.status.error_frames == 0) {
      bus.state = InterfaceState::absent;
    }
    is_empty = is_empty && bus.state == InterfaceState::absent;
  }
  if (is_empty) {
    throw std::runtime_error(joined(logs.readers(), &CandumpReader::no_frame, "; "));
  }
  observation.malformed_lines = joined_if(
      logs.readers(), [](const CandumpReader& log) { return log.malformed_lines() != 0; },
      &CandumpReader::malformed);
  return observation;
}

}  // namespace cremed
