// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/source/candump.hpp"
#include "tools/dump/record_writer.hpp"

namespace cremed {

/// Decodes a log line by line: the scans of the radars of a configuration, and speed and yaw rate
/// as [vehicle] names them or as they are sent to an ARS408.
class ScanReader {
 public:
  /// `writer` must outlive the reader.
  ScanReader(const Configuration& configuration, RecordWriter& writer);

  void add(const CandumpLine& line);
  /// End of the log: open scans close.
  void finish();

  /// Names of radars without a scan so far.
  [[nodiscard]] std::string silent() const;

 private:
  /// Not movable: the assembler refers to the decoder.
  struct Radar {
    explicit Radar(const RadarConfiguration& configuration);
    std::string name;
    std::string interface;
    std::unique_ptr<RadarDecoder> decoder;
    ScanAssembler assembler;
  };
  struct Signal {
    std::string interface;
    std::uint32_t id;
    VehicleSignal signal;
  };
  void add_signals(const Configuration& configuration);
  void add_frame(std::string_view interface, const CanFrame& frame);
  void write_scans(Radar& radar);

  RecordWriter& writer_;
  std::vector<std::unique_ptr<Radar>> radars_;
  std::vector<Signal> signals_;
};

}  // namespace cremed
