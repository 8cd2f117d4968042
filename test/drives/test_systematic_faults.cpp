// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/faults/parked_drive.hpp"
#include "test/faults/start_drive.hpp"
#include "test/faults/systematic_matrix.hpp"
#include "test/faults/unusual_faults.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE("Simulated drive of the nuScenes car: each systematic fault", "[long]") {
  const Configuration car = load_configuration(CREMED_SOURCE_DIR "/config/nuscenes-singapore.toml");
  const FaultDrive drive = simulated_fault_drive("bends", 20.0, car.radars);
  SystematicMatrix matrix(&NotYet::simulated);
  matrix.run_healthy("healthy", drive);
  matrix.run_faults(drive);
  matrix.check();
}

TEST_CASE("Clock steps and halts do not mislead Bosch GPRs, whose counters turn after four scans") {
  std::vector<RadarConfiguration> radars = four_radars();
  for (RadarConfiguration& radar : radars) {
    radar.decoder = BoschGprOptions{};
  }
  SystematicMatrix matrix(&NotYet::simulated);
  for (const char* scenario : {"bends", "stop-and-go"}) {
    const FaultDrive drive = simulated_fault_drive(scenario, 16.0, radars);
    matrix.run_faults(drive, "clock step");
    matrix.run_faults(drive, "halts");
  }
  matrix.check();
}

TEST_CASE("Regimes of the nuScenes car, simulated: nobody is named while nothing is wrong",
          "[long]") {
  const Configuration car = load_configuration(CREMED_SOURCE_DIR "/config/nuscenes-singapore.toml");
  SystematicMatrix matrix(&NotYet::simulated);
  for (const char* regime : {"stop-and-go", "standing", "crowd", "field", "tunnel", "jam",
                             "reversing", "braking", "garage", "campus"}) {
    matrix.run_healthy(regime, simulated_fault_drive(regime, 50.0, car.radars));
  }
  // A radar alone allows for side slip with three degrees of freedom only.
  std::vector<RadarConfiguration> three_dof = car.radars;
  for (RadarConfiguration& radar : three_dof) {
    radar.ego_motion.registration.degrees_of_freedom = 3;
  }
  matrix.run_healthy("skid", simulated_fault_drive("skid", 50.0, three_dof));
  // Drives on which a radar's own check finds it wrong by chance.
  for (const char* regime : {"bends", "braking"}) {
    matrix.run_healthy(regime, simulated_fault_drive(regime, 10.0, car.radars, 5));
  }
  matrix.check();
}

TEST_CASE("A parked vehicle stays parked beside a train, a convoy, a jam that starts", "[long]") {
  SystematicMatrix matrix(&NotYet::simulated);
  for (const auto& [name, neighbour] : kNeighbours) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      matrix.run_healthy(std::string(name), ParkedDrive(neighbour, seed).drive());
    }
  }
  matrix.check();
}

TEST_CASE("Each systematic fault of a short drive leaves odometry") {
  const FaultDrive drive = simulated_fault_drive("bends", 2.0);
  for (const FaultCase& fault : SystematicFaults(drive).all()) {
    CAPTURE(fault.kind, fault.of);
    CHECK_FALSE(record(drive, fault).sink.odometries.empty());
  }
}

constexpr std::size_t kFrontOfThree = 0;
constexpr std::array<std::size_t, 2> kBehind{3, 4};

Configuration car_with_two_behind() {
  Configuration car = load_configuration(CREMED_SOURCE_DIR "/config/nuscenes-singapore.toml");
  REQUIRE(car.radars.at(kFrontOfThree).name == "front");
  REQUIRE(car.radars.at(kBehind[0]).name == "rear_left");
  REQUIRE(car.radars.at(kBehind[1]).name == "rear_right");
  return car;
}

TEST_CASE("Two of three radars with one wrong scale of Doppler do not silence the third") {
  const double factor = GENERATE(0.8, 0.9, -1.0);
  const FaultDrive drive = simulated_fault_drive("bends", 20.0, car_with_two_behind().radars);
  FaultCase fault{"pair", "", {drive.start_us(), kNever}};
  fault.configure = [=](FaultCase::Radars& radars) {
    for (const std::size_t i : kBehind) {
      radars[i].ego_motion.correction.doppler_scale *= factor;
    }
  };
  const DriveFigures figures = judged(drive, fault);
  CAPTURE(factor, figures.radars[kFrontOfThree].left_out, figures.beyond_share());
  CHECK(figures.status_share(OdometryStatus::ok) > 0.9);
  CHECK(figures.beyond_share() < 0.02);
  CHECK(figures.radars[kFrontOfThree].left_out < 0.05);
  for (const std::size_t i : kBehind) {
    CHECK(figures.radars[i].left_out > 0.9);
  }
}

TEST_CASE("Two of three radars that are late alike do not outvote the third") {
  const std::int64_t delay_us = GENERATE(300'000, 500'000);
  const FaultDrive drive = simulated_fault_drive("stop-and-go", 30.0, car_with_two_behind().radars);
  FaultCase fault{"pair", "", {drive.start_us(), kNever}};
  fault.put_in = both(put(with_late_stamps, kBehind[0], delay_us),
                      put(with_late_stamps, kBehind[1], delay_us));
  const DriveFigures figures = judged(drive, fault);
  CAPTURE(delay_us, figures.radars[kFrontOfThree].left_out, figures.beyond_share());
  // Two seconds of the first start from rest, in which two are against one.
  CHECK(figures.radars[kFrontOfThree].left_out < 0.1);
  CHECK(figures.beyond_share() < 0.12);
  for (const std::size_t i : kBehind) {
    CHECK(figures.radars[i].left_out > 0.7);
  }
}

TEST_CASE("Lateral radars drive on when those ahead are gone, and hand over to them again") {
  const std::string scenario = GENERATE("bends", "stop-and-go");
  const Configuration car = load_configuration(CREMED_SOURCE_DIR "/config/nuscenes-boston.toml");
  const FaultDrive drive = simulated_fault_drive(scenario, 16.0, car.radars);
  const std::vector<FaultCase> faults = UnusualFaults(drive).all();
  const auto fault = std::find_if(faults.begin(), faults.end(), [](const FaultCase& each) {
    return each.kind == "only sides for 8 s";
  });
  REQUIRE(fault != faults.end());
  const DriveFigures figures = judged(drive, *fault);
  const double usable = figures.status_share(OdometryStatus::ok) +
                        figures.status_share(OdometryStatus::standing_still);
  CAPTURE(scenario, usable, figures.beyond_share());
  CHECK(usable > 0.95);
  CHECK(verdict_of(*fault, figures).failures().empty());  // Soon right again, after the 8 s too.
}

TEST_CASE("A Doppler scale that all radars share is learned, and forgotten when it ends") {
  const std::string kind = GENERATE("all scale 0.95 for 8 s", "all scale 1.05 for 8 s");
  const FaultDrive drive = simulated_fault_drive("bends", 24.0, car_with_two_behind().radars);
  const std::vector<FaultCase> faults = UnusualFaults(drive).all();
  const auto fault = std::find_if(faults.begin(), faults.end(),
                                  [&](const FaultCase& each) { return each.kind == kind; });
  REQUIRE(fault != faults.end());
  const DriveFigures figures = judged(drive, *fault);
  CAPTURE(kind, figures.beyond_share(), verdict_of(*fault, figures).failures());
  CHECK(figures.status_share(OdometryStatus::ok) > 0.9);
  CHECK(verdict_of(*fault, figures).failures().empty());
  // Named in the status of each second, within two of the begin and until three after the end.
  const int named =
      figures.radars[kFrontOfThree].causes.at(static_cast<std::size_t>(FaultKind::scale));
  CHECK(named >= 6);
  CHECK(named <= 11);
}

TEST_CASE("A counter that is one cycle off after a silence is no step of the clock") {
  const FaultDrive drive = simulated_fault_drive("bends", 14.0, car_with_two_behind().radars);
  const std::size_t radar = 0;
  const FaultTime silence{drive.start_us() + 5'000'000, drive.start_us() + 9'000'000};
  FaultCase fault{"one cycle off", "", {silence.until_us, kNever}};
  fault.put_in = [&](const FaultDrive& d, FaultTime time) {
    Frames frames = with_silence(d.frames, silence, only(radar));
    for (CanFrame& frame : frames) {
      if (frame.interface == radar && time.has(frame) &&
          is_message(frame, Ars408Message::cluster_status)) {
        const unsigned counter = 256U * frame.data[2] + frame.data[3] - 1U;
        frame.data[2] = static_cast<std::uint8_t>(counter >> 8U);
        frame.data[3] = static_cast<std::uint8_t>(counter);
      }
    }
    return frames;
  };
  const DriveFigures figures = judged(drive, fault);
  CHECK(figures.status_share(OdometryStatus::ok) > 0.999);
  CHECK(figures.beyond_share() < 0.01);
}

TEST_CASE("A radar mounted upside down drives as well as upright, with its key") {
  std::vector<RadarConfiguration> radars = default_radars();
  const FaultDrive upright = simulated_fault_drive("bends", 5.0, radars);
  radars.front().decoder = Ars408Options{.invert_azimuth = true};
  const FaultDrive inverted = simulated_fault_drive("bends", 5.0, radars);
  const auto path = [](const FaultDrive& drive) {
    return record(drive, FaultCase{"none", "", {drive.start_us(), kNever}}).sink.odometries;
  };
  const auto expected = path(upright);
  const auto is = path(inverted);
  REQUIRE(is.size() == expected.size());
  REQUIRE(is.size() > 50);
  for (std::size_t i = 0; i < is.size(); ++i) {
    CHECK(is[i].status == expected[i].status);
    CHECK((is[i].pose - expected[i].pose).norm() < 1e-6);
  }
}

TEST_CASE("An own start beside resting and moving traffic is usable at once, and right", "[long]") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const FaultDrive drive = StartDrive(seed).drive();
    const FaultCase none{"none", "", {drive.start_us() + 1'000'000, kNever}};
    const DriveFigures figures = judged(drive, none);
    CAPTURE(drive.name);
    CHECK(figures.status_share(OdometryStatus::ok) +
              figures.status_share(OdometryStatus::standing_still) >=
          0.98);
    CHECK(verdict_of(none, figures).is_right);
  }
}
