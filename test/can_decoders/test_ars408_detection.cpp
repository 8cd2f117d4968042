// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "test/can_decoders/hex_frame.hpp"

namespace cremed::test {
namespace {

// Raw numbers of a target, so that a test names only what it varies.
struct Raw {
  unsigned id = 3;
  unsigned x = 2551;       // 10.2 m
  unsigned y = 489;        // clusters: -4.5 m; objects: -106.8 m
  unsigned vx = 476;       // -9 m/s
  unsigned vy = 259;       // 0.75 m/s
  unsigned dyn_prop = 1;   // stationary
  unsigned rcs = 145;      // 8.5 dBm2
  unsigned x_rms = 16;     // 0.288
  unsigned y_rms = 19;     // 0.616
  unsigned vx_rms = 13;    // 0.135
  unsigned vy_rms = 21;    // 1.023
  unsigned invalid = 0;    // clusters
  unsigned existence = 7;  // objects
  unsigned state = 2;      // objects: measured
};

std::uint8_t byte(unsigned value) { return static_cast<std::uint8_t>(value & 0xFFU); }

Payload general(const Raw& r) {
  return {byte(r.id),
          byte(r.x >> 5U),
          byte(r.x << 3U | r.y >> 8U),
          byte(r.y),
          byte(r.vx >> 2U),
          byte(r.vx << 6U | r.vy >> 3U),
          byte(r.vy << 5U | r.dyn_prop),
          byte(r.rcs)};
}

Payload quality(const Raw& r, bool object) {
  Payload payload{byte(r.id), byte(r.x_rms << 3U | r.y_rms >> 2U),
                  byte(r.y_rms << 6U | r.vx_rms << 1U | r.vy_rms >> 4U), byte(r.vy_rms << 4U)};
  payload[4] = object ? 0 : byte(r.invalid << 3U | 3U);
  payload[6] = object ? byte(r.existence << 5U | r.state << 2U) : 0;
  return payload;
}

Detection detect(const Ars408Options& options, const Raw& raw) {
  const bool object = options.output == Ars408Output::objects;
  return Ars408Decoder(options).detection({general(raw), quality(raw, object)});
}

double doppler(double x, double y, double vx, double vy) {
  return (x * vx + y * vy) / std::hypot(x, y);
}

TEST_CASE("A cluster becomes polar") {
  const Detection d = detect({}, {});
  CHECK(d.validity == Validity::usable);
  CHECK(d.id == 3);
  CHECK(d.motion == Motion::stationary);
  CHECK(d.range_m == Approx(std::hypot(10.2, -4.5)));
  CHECK(d.azimuth_rad == Approx(std::atan2(-4.5, 10.2)));
  CHECK(d.doppler_mps == Approx(doppler(10.2, -4.5, -9.0, 0.75)));
  CHECK(d.rcs_dbm2 == 8.5);
}

TEST_CASE("The velocity across the line of sight is positive counter-clockwise") {
  const Detection d = detect({}, {});
  CHECK(std::hypot(d.doppler_mps, d.across_mps) == Approx(std::hypot(-9.0, 0.75)));
  // The velocity's direction is the line of sight plus the angle between them.
  CHECK(d.azimuth_rad + std::atan2(d.across_mps, d.doppler_mps) ==
        Approx(std::atan2(0.75, -9.0) - 2.0 * std::acos(-1.0)).margin(1e-9));
  CHECK(detect({}, {.x = 2600, .y = 511, .vx = 512, .vy = 280}).across_mps > 0.0);
  CHECK(detect({.output = Ars408Output::objects}, {.vx = 512, .vy = 256}).across_mps == 0.0);
}

TEST_CASE("Azimuth is positive to the left, Doppler negative when closing") {
  CHECK(detect({}, {.y = 600}).azimuth_rad > 0.0);
  CHECK(detect({}, {.x = 2600, .y = 512, .vx = 500, .vy = 256}).doppler_mps < 0.0);
  CHECK(std::abs(detect({}, {.x = 2400, .y = 512}).azimuth_rad) > 1.5707);  // Behind.
}

TEST_CASE("Mounted upside down, the sensor's left is the right") {
  for (const Ars408Output output : {Ars408Output::clusters, Ars408Output::objects}) {
    const Detection seen = detect({.output = output}, {});
    const Detection upright = detect({.output = output, .invert_azimuth = true}, {});
    CHECK(seen.azimuth_rad != 0.0);
    CHECK(upright.azimuth_rad == -seen.azimuth_rad);
    CHECK(upright.across_mps == -seen.across_mps);
    CHECK(upright.range_m == seen.range_m);
    CHECK(upright.doppler_mps == seen.doppler_mps);
    CHECK(upright.azimuth_std_rad == seen.azimuth_std_rad);
    CHECK(upright.doppler_std_mps == seen.doppler_std_mps);
  }
}

TEST_CASE("Standard deviations follow from finite differences of the polar form") {
  for (const Raw& raw : {Raw{}, Raw{.x = 2550, .y = 612, .vx = 700, .vy = 100},
                         Raw{.x = 2400, .y = 300, .vy_rms = 5}, Raw{.x = 2510, .y = 512}}) {
    const double x = (raw.x - 2500.0) * 0.2;
    const double y = raw.y * 0.2 - 102.3;
    const double vx = raw.vx * 0.25 - 128.0;
    const double vy = raw.vy * 0.25 - 64.0;
    const double std[] = {*ars408_std(byte(raw.x_rms)), *ars408_std(byte(raw.y_rms)),
                          *ars408_std(byte(raw.vx_rms)), *ars408_std(byte(raw.vy_rms))};
    const auto spread = [&](auto f) {
      const double h = 1e-5;
      const double slopes[] = {
          f(x + h, y, vx, vy) - f(x - h, y, vx, vy), f(x, y + h, vx, vy) - f(x, y - h, vx, vy),
          f(x, y, vx + h, vy) - f(x, y, vx - h, vy), f(x, y, vx, vy + h) - f(x, y, vx, vy - h)};
      double variance = 0.0;
      for (int i = 0; i < 4; ++i) {
        variance += std::pow(slopes[i] / (2.0 * h) * std[i], 2);
      }
      return std::sqrt(variance);
    };
    const Detection d = detect({}, raw);
    CHECK(d.range_std_m ==
          Approx(spread([](double a, double b, double, double) { return std::hypot(a, b); })));
    CHECK(d.azimuth_std_rad ==
          Approx(spread([](double a, double b, double, double) { return std::atan2(b, a); })));
    CHECK(d.doppler_std_mps == Approx(spread([&](double, double, double a, double b) {
            return doppler(x, y, a, b);  // Along the true line of sight.
          })));
  }
}

TEST_CASE("Motion class of each DynProp") {
  const Motion expected[] = {Motion::moving,     Motion::stationary, Motion::moving,
                             Motion::stationary, Motion::unknown,    Motion::stationary,
                             Motion::moving,     Motion::stationary};
  for (unsigned code = 0; code < 8; ++code) {
    INFO(code);
    CHECK(detect({}, {.dyn_prop = code}).motion == expected[code]);
  }
}

TEST_CASE("Only the configured DynProps are usable") {
  for (unsigned code = 0; code < 8; ++code) {
    INFO(code);
    const bool kept = code == 1 || code == 3 || code == 5;
    CHECK(detect({}, {.dyn_prop = code}).validity == (kept ? Validity::usable : Validity::moving));
    const Ars408Options only{.keep_dyn_props = byte(1U << code)};
    CHECK(detect(only, {.dyn_prop = code}).validity == Validity::usable);
    CHECK(detect(only, {.dyn_prop = (code + 1) % 8}).validity == Validity::moving);
  }
}

TEST_CASE("Only the configured InvalidStates are usable") {
  for (unsigned code = 0; code < 32; ++code) {
    INFO(code);
    const bool kept = code == 0 || code == 4 || code == 11;
    CHECK(detect({}, {.invalid = code}).validity ==
          (kept ? Validity::usable : Validity::invalid_state));
    CHECK(detect({.keep_invalid_states = 1U << code}, {.invalid = code}).validity ==
          Validity::usable);
  }
}

TEST_CASE("Without a standard deviation there is no estimate") {
  const std::vector<Raw> none = {{.x_rms = 31},
                                 {.y_rms = 31},
                                 {.vx_rms = 31},
                                 {.vy_rms = 31},
                                 {.x_rms = 0, .y_rms = 0, .vx_rms = 0, .vy_rms = 0}};
  for (const Raw& raw : none) {
    const Detection d = detect({}, raw);
    CHECK(d.validity == Validity::no_noise);
    CHECK(d.range_m == Approx(std::hypot(10.2, -4.5)));
    CHECK(d.range_std_m == 0.0);
    CHECK(d.azimuth_std_rad == 0.0);
    CHECK(d.doppler_std_mps == 0.0);
  }
  // A single code of 0 is a normal standard deviation.
  CHECK(detect({}, {.x_rms = 0, .y_rms = 0, .vx_rms = 0}).validity == Validity::usable);
  CHECK(detect({}, {.y_rms = 0, .vx_rms = 0, .vy_rms = 0}).validity == Validity::usable);
}

TEST_CASE("An object has its own lateral grid") {
  const Detection d = detect({.output = Ars408Output::objects}, {.y = 1026});
  CHECK(d.validity == Validity::usable);
  CHECK(d.range_m == Approx(std::hypot(10.2, 0.6)));
  CHECK(d.azimuth_rad == Approx(std::atan2(0.6, 10.2)));
}

TEST_CASE("An object in the sensor's origin has no position") {
  const Detection d = detect({.output = Ars408Output::objects}, {.x = 2500, .y = 1023});
  CHECK(d.validity == Validity::no_position);
  CHECK(d.range_m == 0.0);
  CHECK(d.azimuth_rad == 0.0);
  CHECK(d.doppler_mps == 0.0);
  CHECK(d.range_std_m == 0.0);
}

TEST_CASE("Objects need a probability of existence") {
  for (unsigned code = 0; code < 8; ++code) {
    INFO(code);
    const Ars408Options standard{.output = Ars408Output::objects};
    CHECK(detect(standard, {.existence = code}).validity ==
          (code >= 5 ? Validity::usable : Validity::low_existence));
    const Ars408Options any{.output = Ars408Output::objects, .min_existence_code = 0};
    CHECK(detect(any, {.existence = code}).validity == Validity::usable);
  }
}

TEST_CASE("Objects the sensor has deleted are kept out") {
  for (unsigned state = 0; state < 8; ++state) {
    INFO(state);
    const bool deleted = state == 0 || state == 4;
    CHECK(detect({.output = Ars408Output::objects}, {.state = state}).validity ==
          (deleted ? Validity::invalid_state : Validity::usable));
  }
}

TEST_CASE("The first fault in the documented order is the validity") {
  const Ars408Options objects{.output = Ars408Output::objects};
  Raw raw{
      .x = 2500, .y = 1023, .dyn_prop = 0, .x_rms = 31, .invalid = 7, .existence = 1, .state = 0};
  CHECK(detect(objects, raw).validity == Validity::no_position);
  raw.x = 2600;
  CHECK(detect(objects, raw).validity == Validity::no_noise);
  CHECK(detect({}, raw).validity == Validity::no_noise);
  raw.x_rms = 16;
  CHECK(detect(objects, raw).validity == Validity::invalid_state);
  CHECK(detect({}, raw).validity == Validity::invalid_state);
  raw.state = 2;
  CHECK(detect(objects, raw).validity == Validity::moving);
  raw.dyn_prop = 1;
  CHECK(detect(objects, raw).validity == Validity::low_existence);
}

}  // namespace
}  // namespace cremed::test
