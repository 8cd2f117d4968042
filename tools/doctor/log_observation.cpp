// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/log_observation.hpp"

#include <stdexcept>

#include "daemon/source/candump_reader.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {

Observation observe_log(const Configuration& configuration, const std::string& path) {
  Observer observer(configuration);
  CandumpReader log(path);
  for (CandumpLine line; log.next(line);) {
    if (line.status == CandumpStatus::frame) {
      observer.add(line.interface_name, line.frame);
    } else if (line.status == CandumpStatus::dropped) {
      observer.add_lost(line.interface_name, line.dropped_frames);
    }
  }
  if (const std::string problem = log.problem(); !problem.empty()) {
    throw std::runtime_error(problem);
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
    throw std::runtime_error(log.no_frame());
  }
  observation.malformed_lines = log.malformed();
  return observation;
}

}  // namespace cremed
