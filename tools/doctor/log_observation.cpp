// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/log_observation.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "daemon/process/message_text.hpp"
#include "daemon/source/line_reader.hpp"
#include "daemon/source/log_format.hpp"
#include "daemon/source/stamp_order.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {

void read_log(const std::string& path, const std::function<void(const CandumpLine&)>& take) {
  LineReader reader(path);
  refuse_foreign_format(reader.begin(), path);
  std::string_view text;
  for (auto status = reader.next(text); status != LineReader::Status::end;
       status = reader.next(text)) {
    if (status == LineReader::Status::failed) {
      throw std::runtime_error(concat({path, ": ", std::strerror(errno)}));
    }
    if (status == LineReader::Status::line) {
      if (reader.line_number() == 1) {
        refuse_foreign_format(text, path);
      }
      take(parse_candump_line(text));
    }
  }
}

std::string no_frame_in(const std::string& path) {
  return concat({path, ": no CAN frame in it; lines of `candump -L` are expected"});
}

Observation observe_log(const Configuration& configuration, const std::string& path) {
  Observer observer(configuration);
  StampOrder stamps;
  read_log(path, [&](const CandumpLine& line) {
    if (line.status == CandumpStatus::frame) {
      observer.add(line.interface_name, line.frame);
      stamps.add(line.interface_name, line.frame.stamp_us);
    } else if (line.status == CandumpStatus::dropped) {
      observer.add_lost(line.interface_name, line.dropped_frames);
    }
  });
  if (const std::string problem = stamps.problem(path); !problem.empty()) {
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
    throw std::runtime_error(no_frame_in(path));
  }
  return observation;
}

}  // namespace cremed
