// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A radar family that exists in this file only: cremed supports it without knowing it.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/radar_family.hpp"
#include "daemon/configuration/configuration_summary.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/report/report.hpp"
#include "test/tools/doctor_bench.hpp"
#include "test/tools/pipeline_bench.hpp"
#include "tools/doctor/suggestion.hpp"

namespace fan {

using namespace cremed;

constexpr std::uint32_t kFirstId = 0x500;
constexpr std::uint8_t kHeaderLength = 2;
constexpr std::uint8_t kTargetLength = 7;

struct FanOptions {
  std::uint8_t channel = 0;
  bool invert_doppler = false;
};

const RadarFamily& family_of(const FanOptions& options);

std::uint32_t header_id(const FanOptions& options) { return kFirstId + 2U * options.channel; }

/// One message per target: its number, then range in cm, azimuth in 0.1 mrad, Doppler in cm/s.
class FanDecoder final : public RadarDecoder {
 public:
  explicit FanDecoder(const FanOptions& options) : options_(options) {}

  ScanPart decode(const CanFrame& frame) override {
    const std::uint32_t header = header_id(options_);
    if (!frame.is_classic_data() || (frame.id != header && frame.id != header + 1)) {
      return {};
    }
    ++counters_.frames;
    if (frame.length != (frame.id == header ? kHeaderLength : kTargetLength)) {
      ++counters_.wrong_length;
      return {};
    }
    ScanPart part{.kind = frame.id == header ? ScanPart::Kind::header : ScanPart::Kind::target,
                  .slot = frame.data[0],
                  .counter = frame.data[0],
                  .target_count = frame.data[1],
                  .stamp_us = frame.stamp_us};
    std::copy_n(frame.data.begin(), part.payload.size(), part.payload.begin());
    return part;
  }

  [[nodiscard]] Detection detection(const TargetPayload& target) const override {
    const auto field = [&](std::size_t byte) {
      return static_cast<std::int16_t>(target[0][byte] | target[0][byte + 1] << 8U);
    };
    return {.range_m = field(1) * 0.01,
            .azimuth_rad = field(3) * 1e-4,
            .doppler_mps = field(5) * (options_.invert_doppler ? -0.01 : 0.01),
            .range_std_m = 0.1,
            .azimuth_std_rad = 0.005,
            .doppler_std_mps = 0.05,
            .validity = Validity::usable};
  }

  [[nodiscard]] ScanFraming framing() const override {
    return {.has_header = true, .counter_modulus = 256, .messages = 1};
  }
  [[nodiscard]] RadarHealth health() const override { return {}; }

 private:
  FanOptions options_;
};

RadarSettings read(OptionReader& reader) {
  FanOptions options;
  reader.integer("channel", options.channel, 0, 7);
  reader.boolean("invert_doppler", options.invert_doppler);
  return options;
}

std::unique_ptr<RadarDecoder> make_decoder(const FanOptions& options) {
  return std::make_unique<FanDecoder>(options);
}

IdSet sent_ids(const FanOptions& options) {
  IdSet ids;
  return ids.set(header_id(options)).set(header_id(options) + 1);
}

std::string label(const FanOptions&) { return "Fan"; }

std::string key(const FanOptions& options) {
  return "channel = " + std::to_string(options.channel);
}

std::string describe(const FanOptions& options) {
  return "a Fan with channel " + std::to_string(options.channel);
}

std::vector<RadarSettings> recognise(const BusTraffic& bus, IdSet& unexplained) {
  std::vector<RadarSettings> radars;
  for (std::uint8_t channel = 0; channel < 8; ++channel) {
    const std::uint32_t id = header_id({channel});
    if (unexplained[id] && bus.ids[id].length == kHeaderLength) {
      unexplained &= ~sent_ids({channel});
      radars.emplace_back(FanOptions{channel});
    }
  }
  return radars;
}

const RadarFamily& family_of(const FanOptions& /*options*/) {
  static constexpr RadarFamily kFan{.type = "fan",
                                    .read = read,
                                    .make_decoder = kOfSettings<make_decoder>,
                                    .sent_ids = kOfSettings<sent_ids>,
                                    .label = kOfSettings<label>,
                                    .describe = kOfSettings<describe>,
                                    .key = kOfSettings<key>,
                                    .recognise = recognise,
                                    .doppler_sign_key = "invert_doppler"};
  return kFan;
}

}  // namespace fan

using namespace cremed;
using namespace cremed::test;

namespace {

std::vector<const RadarFamily*> three_families() {
  std::vector<const RadarFamily*> families(radar_families().begin(), radar_families().end());
  families.push_back(&family_of(fan::FanOptions{}));
  return families;
}

const std::string kText = R"([[radar]]
name = "front"
type = "fan"
interface = "can3"
channel = 2
mount = { x_m = 0.0, y_m = 0.0, yaw_rad = 0.0 }
)";

Configuration parse_fan(const std::string& text) {
  Configuration configuration = parse_configuration(text, "fan.toml", three_families());
  configuration.output.lcm_url = "none";
  return configuration;
}

std::string refusal(const std::string& text) {
  try {
    parse_fan(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "accepted";
}

void put(CanFrame& frame, std::size_t byte, double value) {
  const auto rounded = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(value)));
  frame.data[byte] = static_cast<std::uint8_t>(rounded & 0xFFU);
  frame.data[byte + 1] = static_cast<std::uint8_t>(rounded >> 8U);
}

constexpr double kSpeedMps = 10.0;

/// Frames of a Fan on channel 2 with fixed posts on a straight drive, ten scans a second.
std::vector<CanFrame> fan_drive() {
  constexpr int kScans = 20;
  constexpr int kTargets = 30;
  std::vector<CanFrame> frames;
  for (int scan = 0; scan < kScans; ++scan) {
    CanFrame header{.stamp_us = 1'000'000 + scan * 100'000, .id = 0x504, .length = 2};
    header.data[0] = static_cast<std::uint8_t>(scan);
    header.data[1] = kTargets;
    frames.push_back(header);
    for (int i = 0; i < kTargets; ++i) {
      const double x_m = 30.0 + 3.0 * i - 0.1 * scan * kSpeedMps;
      const double y_m = (i % 2 == 0 ? 1.0 : -1.0) * (5.0 + i % 7);
      CanFrame target{.stamp_us = header.stamp_us + 200 * (i + 1), .id = 0x505, .length = 7};
      target.data[0] = static_cast<std::uint8_t>(i);
      put(target, 1, 100.0 * std::hypot(x_m, y_m));
      put(target, 3, 1e4 * std::atan2(y_m, x_m));
      put(target, 5, -100.0 * kSpeedMps * x_m / std::hypot(x_m, y_m));
      frames.push_back(target);
    }
  }
  return frames;
}

}  // namespace

TEST_CASE("A third family is configured by its type") {
  const Configuration configuration = parse_fan(kText + "invert_doppler = true\n");
  const auto* options = configuration.radars.at(0).decoder.as<fan::FanOptions>();
  REQUIRE(options != nullptr);
  CHECK(options->channel == 2);
  CHECK(options->invert_doppler);
  CHECK(configuration.radars[0].decoder.as<Ars408Options>() == nullptr);
  CHECK(configuration.radars[0].ego_motion.correction.rotation_lead_s == 0.0);
}

TEST_CASE("Its keys are checked and told from those of others") {
  std::string nine = kText;
  nine.replace(nine.find("channel = 2"), 11, "channel = 9");
  CHECK(refusal(nine) == "fan.toml:5: radar.channel: is 9; must be an integer from 0 to 7");
  CHECK_THAT(
      refusal("[[radar]]\nname = \"a\"\ntype = \"fun\"\ninterface = \"can0\"\n"
              "mount = { x_m = 0.0, y_m = 0.0, yaw_rad = 0.0 }\n"),
      Catch::Contains(
          "radar.type: is \"fun\"; must be \"ars404\", \"ars408\", \"bosch_gpr\" or \"fan\""));
  CHECK_THAT(refusal(kText + "sensor_id = 1\n"),
             Catch::Contains(
                 "sensor_id: is a key of type \"ars404\" or \"ars408\"; must be left out here"));
  CHECK_THAT(
      refusal(kText + "calibration = { rotation_lead_s = 0.1 }\n"),
      Catch::Contains("is a key of type \"ars404\" or \"ars408\", which receives the yaw rate"));
  CHECK_THAT(refusal("[[radar]]\nname = \"a\"\ntype = \"ars408\"\ninterface = \"can0\"\n"
                     "channel = 1\nmount = { x_m = 0.0, y_m = 0.0, yaw_rad = 0.0 }\n"),
             Catch::Contains("channel: is a key of type \"fan\"; must be left out here"));
  CHECK_THAT(refusal(kText + "[[radar]]\nname = \"b\"\ntype = \"fan\"\ninterface = \"can3\"\n"
                             "channel = 2\nmount = { x_m = 0.0, y_m = 0.0, yaw_rad = 0.0 }\n"),
             Catch::Contains("both use CAN identifier 0x504"));
}

TEST_CASE("--check-config shows it, and its identifiers are let through") {
  const Configuration configuration = parse_fan(kText);
  CHECK_THAT(
      configuration_summary(configuration),
      Catch::Contains("front           fan       can3               0.000    0.000     0.00  "
                      "0x504-0x505\n"));
  CHECK(configuration.radars[0].decoder.label() == "Fan");
  CHECK(ids_on(0, configuration) == IdSet().set(0x504).set(0x505));
}

TEST_CASE("Of its keys only those are advised that it has") {
  const Configuration configuration = parse_fan(kText);
  RadarStatus status;
  const auto remedy_of = [&](FaultKind kind) {
    status.odometry.cause = {kind};
    return fault_finding(configuration.radars[0], status, configuration.radars).remedy;
  };
  CHECK(remedy_of(FaultKind::sign) == "change invert_doppler, or turn mount.yaw_rad by pi");
  CHECK(remedy_of(FaultKind::upside_down) == "if it is mounted upside down, turn it over");
}

TEST_CASE("Its frames become odometry") {
  const Configuration configuration = parse_fan(kText);
  const RecordingSink sink = run_pipeline(configuration.radars, fan_drive());
  REQUIRE(sink.scans[0].size() == 20);
  for (const RadarScan& scan : sink.scans[0]) {
    CHECK(scan.status == ScanStatus::complete);
    CHECK(scan.count == 30);
  }
  REQUIRE(sink.motions[0].size() == 20);
  const EgoMotion& last = sink.motions[0].back();
  CHECK(last.status == MotionStatus::ok);
  CHECK(last.motion.x() == Approx(0.1 * kSpeedMps).margin(0.02));
}

TEST_CASE("The doctor recognises it, suggests it and says how it does") {
  Recording traffic;
  for (const CanFrame& frame : fan_drive()) {
    traffic.push_back({"can3", frame});
  }
  const Configuration configuration = parse_fan(kText);
  const Observation observation = observe(configuration, traffic);
  const auto seen = seen_radars(observation.buses.at(0).traffic, three_families());
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].describe() == "a Fan with channel 2");
  CHECK(seen[0].is_same_radar(configuration.radars[0].decoder));
  CHECK(seen_radars(observation.buses[0].traffic).empty());

  const std::string suggestion = suggested_configuration(observation, three_families());
  CHECK_THAT(suggestion, Catch::Contains("type = \"fan\"\ninterface = \"can3\"\nchannel = 2\n"));
  for (const Finding& finding : diagnose(configuration, observation)) {
    CHECK(finding.severity == Severity::note);
  }
}
