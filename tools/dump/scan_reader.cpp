// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dump/scan_reader.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/can_decoders/ars408.hpp"
#include "daemon/process/joined.hpp"

namespace cremed {

ScanReader::Radar::Radar(const RadarConfiguration& configuration)
    : name(configuration.name),
      interface(configuration.interface),
      decoder(configuration.decoder.make_decoder()),
      assembler(*decoder, std::llround(configuration.scan_timeout_s * 1e6),
                std::llround(configuration.stamp_offset_s * 1e6)) {}

ScanReader::ScanReader(const Configuration& configuration, RecordWriter& writer) : writer_(writer) {
  for (const RadarConfiguration& radar : configuration.radars) {
    radars_.push_back(std::make_unique<Radar>(radar));
  }
  add_signals(configuration);
}

void ScanReader::add_signals(const Configuration& configuration) {
  const auto add = [&](const std::string& interface, std::uint32_t id, VehicleSignal signal) {
    const bool is_known = std::ranges::any_of(signals_, [&](const Signal& known) {
      return known.interface == interface && known.id == id;
    });
    if (!is_known) {
      signals_.push_back({interface, id, signal});
    }
  };
  for (std::size_t i = 0; i < kVehicleSignals; ++i) {
    const auto signal = static_cast<VehicleSignal>(i);
    if (configuration.vehicle.is_used(signal)) {
      add(configuration.vehicle.interface, *configuration.vehicle.id(signal), signal);
    }
    for (const RadarConfiguration& radar : configuration.radars) {
      if (const auto* const ars408 = radar.decoder.as<Ars408Options>()) {
        add(radar.interface, ars408_id(*VehicleConfiguration().id(signal), ars408->sensor_id),
            signal);
      }
    }
  }
}

void ScanReader::add(const CandumpLine& line) {
  if (line.status == CandumpStatus::frame) {
    add_frame(line.interface_name, line.frame);
  } else if (line.status == CandumpStatus::dropped) {
    writer_.lost(std::string(line.interface_name), line.dropped_frames);
    for (const auto& radar : radars_) {
      if (radar->interface == line.interface_name || line.interface_name == kAllInterfaces) {
        radar->assembler.mark_dropped();
      }
    }
  }
}

void ScanReader::add_frame(std::string_view interface, const CanFrame& frame) {
  for (const Signal& signal : signals_) {
    if (signal.id == frame.id && signal.interface == interface) {
      if (const auto reading = decode_vehicle_reading(signal.signal, frame)) {
        writer_.reading(signal.interface, frame.id, *reading);
      }
    }
  }
  for (const auto& radar : radars_) {
    if (radar->interface == interface) {
      radar->assembler.expire(frame.stamp_us);
      write_scans(*radar);
      radar->assembler.add(radar->decoder->decode(frame));
      write_scans(*radar);
    }
  }
}

void ScanReader::write_scans(Radar& radar) {
  while (const RadarScan* const scan = radar.assembler.next()) {
    writer_.scan(radar.interface, radar.name, *scan);
  }
}

void ScanReader::finish() {
  for (const auto& radar : radars_) {
    radar->assembler.finish();
    write_scans(*radar);
  }
}

std::string ScanReader::silent() const {
  const auto is_silent = [](const auto& radar) { return radar->assembler.counters().scans == 0; };
  return joined_if(radars_, is_silent, &Radar::name);
}

}  // namespace cremed
