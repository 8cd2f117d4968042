// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dump/record_writer.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "cremed/estimator/scan/degrees.hpp"
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
std::string line_begin(std::int64_t stamp_us, const std::string& interface) {
  constexpr std::int64_t kUsPerS = 1'000'000;
  return fmt::format("({}.{:06}) {} ", stamp_us / kUsPerS, std::abs(stamp_us % kUsPerS),
                     printable(interface));
}

std::string target_text(const Detection& target) {
  return fmt::format(
      "  id{:4}{:>9.2f} +-{:.2f} m{:>9.2f} +-{:.2f} deg{:>9.2f} +-{:.2f} m/s{:>7.1f} dBm2  {}, {}",
      target.id, target.range_m, target.range_std_m, kDegPerRad * target.azimuth_rad,
      kDegPerRad * target.azimuth_std_rad, target.doppler_mps, target.doppler_std_mps,
      target.rcs_dbm2, name(target.validity), name(target.motion));
}

/// JSON has no NaN.
std::string number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "null";
}

/// Finer than any radar's steps.
std::string target_json(const Detection& target) {
  return fmt::format(
      R"({{"id":{},"range_m":{},"azimuth_rad":{},"doppler_mps":{},"range_std_m":{},)"
      R"("azimuth_std_rad":{},"doppler_std_mps":{},"rcs_dbm2":{},"validity":"{}","motion":"{}"}})",
      target.id, number(target.range_m, 4), number(target.azimuth_rad, 6),
      number(target.doppler_mps, 4), number(target.range_std_m, 4),
      number(target.azimuth_std_rad, 6), number(target.doppler_std_mps, 4),
      number(target.rcs_dbm2, 2), name(target.validity), name(target.motion));
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
    out() << line_begin(scan.stamp_us, interface) << radar << " scan " << scan.counter << ' '
          << name(scan.status) << ", " << scan.count << " of " << scan.announced << " targets";
    for (std::size_t i = 0; with_targets() && i < scan.count; ++i) {
      out() << '\n' << target_text(scan.detections[i]);
    }
    end_record();
  }

  void reading(const std::string& interface, std::uint32_t id,
               const VehicleReading& reading) override {
    out() << line_begin(reading.stamp_us, interface) << hexadecimal(id)
          << (reading.signal == VehicleSignal::speed
                  ? fmt::format(" speed {:.2f} m/s", reading.value)
                  : fmt::format(" yaw rate {:.2f} deg/s", kDegPerRad * reading.value));
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
    out() << fmt::format(
        R"({{"type":"scan","utime":{},"radar":"{}","interface":{},"counter":{},"status":"{}",)"
        R"("announced":{},"count":{})",
        scan.stamp_us, radar, quoted(interface), scan.counter, name(scan.status), scan.announced,
        scan.count);
    if (with_targets()) {
      out() << ",\"targets\":[";
      for (std::size_t i = 0; i < scan.count; ++i) {
        out() << (i == 0 ? "" : ",") << target_json(scan.detections[i]);
      }
      out() << ']';
    }
    out() << '}';
    end_record();
  }

  void reading(const std::string& interface, std::uint32_t id,
               const VehicleReading& reading) override {
    out() << fmt::format(R"({{"type":"vehicle","utime":{},"interface":{},"id":{},"{}":{}}})",
                         reading.stamp_us, quoted(interface), id,
                         reading.signal == VehicleSignal::speed ? "speed_mps" : "yaw_rate_radps",
                         number(reading.value, 6));
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
