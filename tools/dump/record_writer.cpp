// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dump/record_writer.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/output/text_line.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

// By the enumerators' order.
constexpr std::array<std::string_view, 5> kScanStatusNames{
    "complete", "missing_parts", "conflicting_parts", "over_capacity", "dropped_frames"};
constexpr std::array<std::string_view, 7> kValidityNames{
    "usable", "no_noise", "invalid_state", "moving", "low_existence", "no_position", "empty"};
constexpr std::array<std::string_view, 3> kMotionNames{"unknown", "moving", "stationary"};

std::string_view name(ScanStatus status) {
  return kScanStatusNames[static_cast<std::size_t>(status)];
}
std::string_view name(Validity validity) {
  return kValidityNames[static_cast<std::size_t>(validity)];
}
std::string_view name(Motion motion) { return kMotionNames[static_cast<std::size_t>(motion)]; }

/// "(1436509052.249713) can0 ", as candump -L.
TextLine line_at(std::int64_t stamp_us, std::string_view interface) {
  constexpr std::int64_t kUsPerS = 1'000'000;
  const std::string fraction = std::to_string(std::abs(stamp_us % kUsPerS));
  TextLine line;
  line.text("(").integer(stamp_us / kUsPerS).text(".");
  line.text(std::string(6 - fraction.size(), '0')).text(fraction);
  line.text(") ").text(interface).text(" ");
  return line;
}

/// Right-aligned.
void add(TextLine& line, double value, int decimals, std::size_t width) {
  const std::string text(TextLine().fixed(value, decimals).view());
  line.text(std::string(width - std::min(width, text.size()), ' ')).text(text);
}

void add_with_sigma(TextLine& line, double value, double sigma, int decimals,
                    std::string_view unit) {
  add(line, value, decimals, 9);
  line.text(" +-").fixed(sigma, decimals).text(" ").text(unit);
}

void add_target(TextLine& line, const Detection& target) {
  line.text("  id");
  add(line, target.id, 0, 4);
  add_with_sigma(line, target.range_m, target.range_std_m, 2, "m");
  add_with_sigma(line, kDegPerRad * target.azimuth_rad, kDegPerRad * target.azimuth_std_rad, 2,
                 "deg");
  add_with_sigma(line, target.doppler_mps, target.doppler_std_mps, 2, "m/s");
  add(line, target.rcs_dbm2, 1, 7);
  line.text(" dBm2  ").text(name(target.validity)).text(", ").text(name(target.motion));
}

/// JSON has no NaN.
TextLine& add_key(TextLine& line, std::string_view key, double value, int decimals) {
  line.text(",\"").text(key).text("\":");
  return std::isfinite(value) ? line.fixed(value, decimals) : line.text("null");
}

TextLine& add_name(TextLine& line, std::string_view key, std::string_view value) {
  return line.text(",\"").text(key).text("\":\"").text(value).text("\"");
}

/// Finer than any radar's steps.
TextLine target_json(const Detection& target) {
  TextLine line;
  line.text("{\"id\":").integer(target.id);
  add_key(line, "range_m", target.range_m, 4);
  add_key(line, "azimuth_rad", target.azimuth_rad, 6);
  add_key(line, "doppler_mps", target.doppler_mps, 4);
  add_key(line, "range_std_m", target.range_std_m, 4);
  add_key(line, "azimuth_std_rad", target.azimuth_std_rad, 6);
  add_key(line, "doppler_std_mps", target.doppler_std_mps, 4);
  add_key(line, "rcs_dbm2", target.rcs_dbm2, 2);
  add_name(line, "validity", name(target.validity));
  add_name(line, "motion", name(target.motion));
  line.text("}");
  return line;
}

/// A name of a log may hold anything.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

class TextRecords final : public RecordWriter {
 public:
  using RecordWriter::RecordWriter;

  void scan(const std::string& interface, const std::string& radar,
            const RadarScan& scan) override {
    TextLine line = line_at(scan.stamp_us, printable(interface));
    line.text(radar).text(" scan ").integer(scan.counter).text(" ").text(name(scan.status));
    line.text(", ").integer(scan.count).text(" of ").integer(scan.announced).text(" targets");
    out() << line.view();
    for (std::size_t i = 0; with_targets() && i < scan.count; ++i) {
      TextLine target;
      add_target(target, scan.detections[i]);
      out() << '\n' << target.view();
    }
    end_record();
  }

  void reading(const std::string& interface, std::uint32_t id,
               const VehicleReading& reading) override {
    TextLine line = line_at(reading.stamp_us, printable(interface));
    line.text(hexadecimal(id));
    if (reading.signal == VehicleSignal::speed) {
      line.text(" speed ").fixed(reading.value, 2).text(" m/s");
    } else {
      line.text(" yaw rate ").fixed(kDegPerRad * reading.value, 2).text(" deg/s");
    }
    out() << line.view();
    end_record();
  }

  void lost(const std::string& interface, std::uint64_t frames) override {
    out() << printable(interface) << " lost " << counted(frames, "frame");
    end_record();
  }
};

class JsonRecords final : public RecordWriter {
 public:
  using RecordWriter::RecordWriter;

  void scan(const std::string& interface, const std::string& radar,
            const RadarScan& scan) override {
    TextLine line;
    line.text("{\"type\":\"scan\",\"utime\":").integer(scan.stamp_us);
    add_name(line, "radar", radar);
    line.text(",\"interface\":").text(quoted(interface));
    line.text(",\"counter\":").integer(scan.counter);
    add_name(line, "status", name(scan.status));
    line.text(",\"announced\":").integer(scan.announced).text(",\"count\":").integer(scan.count);
    out() << line.view();
    if (with_targets()) {
      out() << ",\"targets\":[";
      for (std::size_t i = 0; i < scan.count; ++i) {
        out() << (i == 0 ? "" : ",") << target_json(scan.detections[i]).view();
      }
      out() << ']';
    }
    out() << '}';
    end_record();
  }

  void reading(const std::string& interface, std::uint32_t id,
               const VehicleReading& reading) override {
    TextLine line;
    line.text("{\"type\":\"vehicle\",\"utime\":").integer(reading.stamp_us);
    line.text(",\"interface\":").text(quoted(interface)).text(",\"id\":").integer(id);
    add_key(line, reading.signal == VehicleSignal::speed ? "speed_mps" : "yaw_rate_radps",
            reading.value, 6);
    out() << line.view() << '}';
    end_record();
  }

  void lost(const std::string& interface, std::uint64_t frames) override {
    out() << R"({"type":"lost","interface":)" << quoted(interface) << ",\"frames\":" << frames
          << '}';
    end_record();
  }
};

}  // namespace

void RecordWriter::end_record() {
  out_ << '\n';
  if (options_.is_live) {
    out_.flush();
  }
}

std::unique_ptr<RecordWriter> make_record_writer(std::ostream& out, const RecordOptions& options) {
  if (options.is_json) {
    return std::make_unique<JsonRecords>(out, options);
  }
  return std::make_unique<TextRecords>(out, options);
}

}  // namespace cremed
