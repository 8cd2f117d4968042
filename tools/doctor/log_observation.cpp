// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/log_observation.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "daemon/process/message_text.hpp"
#include "daemon/source/candump.hpp"
#include "daemon/source/line_reader.hpp"
#include "daemon/source/log_format.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {
namespace {

void add_line(std::string_view text, Observer& observer) {
  const CandumpLine line = parse_candump_line(text);
  if (line.status == CandumpStatus::frame) {
    observer.add(line.interface_name, line.frame);
  } else if (line.status == CandumpStatus::dropped) {
    observer.add_lost(line.interface_name, line.dropped_frames);
  }
}

void read_all(LineReader& reader, const std::string& path, Observer& observer) {
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
      add_line(text, observer);
    }
  }
}

}  // namespace

Observation observe_log(const Configuration& configuration, const std::string& path) {
  Observer observer(configuration);
  LineReader reader(path);
  refuse_foreign_format(reader.begin(), path);
  read_all(reader, path, observer);
  Observation observation = observer.finish();
  bool is_empty = true;
  for (BusObservation& bus : observation.buses) {
    if (bus.status.frames + bus.status.error_frames == 0) {
      bus.state = InterfaceState::absent;
    }
    is_empty = is_empty && bus.state == InterfaceState::absent;
  }
  if (is_empty) {
    throw std::runtime_error(
        concat({path, ": no CAN frame in it; lines of `candump -L` are expected"}));
  }
  return observation;
}

}  // namespace cremed
