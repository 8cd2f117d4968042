// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"

namespace cremed {

struct RecordOptions {
  bool is_json = false;  ///< An object a line. SI units, radians, microseconds.
  bool with_targets = true;
  bool is_live = false;  ///< Someone waits for each record.
};

/// Writes what a log holds, as a program or a person reads it.
class RecordWriter {
 public:
  RecordWriter(std::ostream& out, const RecordOptions& options) : out_(out), options_(options) {}
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;
  virtual ~RecordWriter() = default;

  virtual void scan(const std::string& interface, const std::string& radar,
                    const RadarScan& scan) = 0;
  virtual void reading(const std::string& interface, std::uint32_t id,
                       const VehicleReading& reading) = 0;
  /// Frames that the recording lost before its next line.
  virtual void lost(const std::string& interface, std::uint64_t frames) = 0;

 protected:
  [[nodiscard]] std::ostream& out() { return out_; }
  [[nodiscard]] bool with_targets() const { return options_.with_targets; }
  void end_record();

 private:
  std::ostream& out_;
  RecordOptions options_;
};

/// As text: a line a record, and one a target below it; stamps as candump writes them.
std::unique_ptr<RecordWriter> make_record_writer(std::ostream& out, const RecordOptions& options);

}  // namespace cremed
