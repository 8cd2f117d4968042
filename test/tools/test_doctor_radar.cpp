// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/process/message_text.hpp"
#include "test/tools/doctor_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// A healthy drive with one change, and the finding that must come first.
struct Case {
  std::string name;
  std::function<void(Configuration&, Recording&)> spoil;
  Severity severity;
  std::string what;
  std::string remedy;
};

Ars408Options& front_options(Configuration& configuration) {
  return *configuration.radars[0].decoder.as<Ars408Options>();
}

/// Each n-th frame of the identifier is lost.
void lose_each(Recording& traffic, const std::string& interface, std::uint32_t id, int n) {
  int count = 0;
  remove_if(traffic,
            [&](const BusFrame& entry) { return is_of(entry, interface, id) && ++count % n == 0; });
}

/// Headers that announce this many near clusters.
void announce(Recording& traffic, std::uint8_t near_count) {
  for (auto& entry : traffic) {
    if (is_of(entry, "can0", 0x600)) {
      entry.frame.data[0] = near_count;
    }
  }
}

std::function<bool(const BusFrame&)> is_between(const Recording& traffic, double begin_s,
                                                double end_s) {
  const std::int64_t first_us = traffic.front().frame.stamp_us;
  return [=](const BusFrame& entry) {
    const double time_s = static_cast<double>(entry.frame.stamp_us - first_us) * 1e-6;
    return time_s >= begin_s && time_s < end_s;
  };
}

/// A second sensor with the same id, delayed, with its own counter.
void add_twin(Recording& traffic, const std::string& interface, std::int64_t later_us) {
  Recording twin;
  for (BusFrame entry : traffic) {
    if (entry.interface == interface) {
      entry.frame.stamp_us += later_us;
      entry.frame.data[2] ^= entry.frame.id == 0x600 ? 0x55U : 0U;
      twin.push_back(entry);
    }
  }
  traffic.insert(traffic.end(), twin.begin(), twin.end());
  std::ranges::stable_sort(
      traffic, [](const auto& a, const auto& b) { return a.frame.stamp_us < b.frame.stamp_us; });
}

void say(Recording& traffic, const std::function<void(Ars408RadarState&)>& change) {
  Ars408RadarState state = good_state();
  change(state);
  report_state(traffic, "can0", state);
}

const std::vector<Case>& cases() {
  static const std::vector<Case> kAll{
      {"another sensor id", [](auto&, auto& traffic) { move_ids(traffic, "can0", 0x30); },
       Severity::error, "front: not an ARS408 with sensor id 0 but an ARS408 with sensor id 3",
       "set sensor_id = 3 for radar \"front\", or give the sensor its id: "
       "`cremed-doctor --configure-ars408 front --sensor-id 3`"},
      {"another base id", [](auto&, auto& traffic) { move_ids(traffic, "can1", 0x60); },
       Severity::error,
       "rear: not a Bosch GPR with base id 0x200 but a Bosch GPR with base id 0x260",
       "set base_id = 0x260 for radar \"rear\""},
      {"another base id that overlaps",
       [](auto&, auto& traffic) { move_ids(traffic, "can1", 0x20); }, Severity::error,
       "but a Bosch GPR with base id 0x220", "set base_id = 0x220"},
      {"a GPR where an ARS408 is expected",
       [](auto& configuration, auto& traffic) {
         configuration.radars[1].decoder = Ars408Options{};
         remove_if(traffic, [](const auto& entry) { return entry.interface == "can0"; });
         configuration.radars.erase(configuration.radars.begin());
       },
       Severity::error, "rear: not an ARS408 with sensor id 0 but a Bosch GPR with base id 0x200",
       "set type = \"bosch_gpr\" and base_id = 0x200"},
      {"an ARS408 where a GPR is expected",
       [](auto& configuration, auto& traffic) {
         configuration.radars[0].decoder = BoschGprOptions{};
         configuration.radars.pop_back();
         remove_if(traffic, [](const auto& entry) { return entry.interface == "can1"; });
       },
       Severity::error, "front: not a Bosch GPR with base id 0x200 but an ARS408 with sensor id 0",
       "set type = \"ars408\" and sensor_id = 0"},
      {"on another bus", [](auto&, auto& traffic) { rename(traffic, "can0", "can7"); },
       Severity::error, "front: an ARS408 with sensor id 0 is on can7, not on can0",
       "set interface = \"can7\" for radar \"front\""},
      {"buses swapped",
       [](auto&, auto& traffic) {
         rename(traffic, "can0", "x");
         rename(traffic, "can1", "can0");
         rename(traffic, "x", "can1");
       },
       Severity::error, "front: an ARS408 with sensor id 0 is on can1, not on can0",
       "set interface = \"can1\""},
      {"the clock of a bus an hour ahead",
       [](auto&, auto& traffic) {
         for (auto& entry : traffic) {
           entry.frame.stamp_us += entry.interface == "can1" ? 3'600'000'000 : 0;
         }
       },
       Severity::warning, "rear: its stamps are ahead of those of all other buses",
       "the clock that stamps this bus"},
      {"other traffic only",
       [](auto&, auto& traffic) {
         for (auto& entry : traffic) {
           entry.frame.id = entry.interface == "can0" ? 0x123 : entry.frame.id;
         }
       },
       Severity::error, "front: frames on can0, but none of an ARS408 with sensor id 0: 0x123",
       "power"},
      {"extended frames only",
       [](auto&, auto& traffic) {
         for (auto& entry : traffic) {
           entry.frame.extended = entry.interface == "can0";
         }
       },
       Severity::error, "extended, remote or FD frames", "power"},
      {"objects instead of clusters",
       [](auto& configuration, auto& traffic) {
         front_options(configuration).output = Ars408Output::objects;
         traffic = recording_of(configuration.radars);
         front_options(configuration).output = Ars408Output::clusters;
       },
       Severity::error, "front: the sensor sends objects, not clusters",
       "`cremed-doctor --configure-ars408 front`"},
      {"clusters instead of objects",
       [](auto& configuration, auto&) {
         front_options(configuration).output = Ars408Output::objects;
       },
       Severity::error, "front: the sensor sends clusters, not objects",
       "set output = \"clusters\""},
      {"no quality, and the sensor says so",
       [](auto&, auto& traffic) {
         remove_if(traffic, [](const auto& entry) { return is_of(entry, "can0", 0x702); });
         say(traffic, [](auto& state) { state.sends_quality = false; });
       },
       Severity::error, "front: the sensor sends no quality (0x201)",
       "`cremed-doctor --configure-ars408 front`"},
      {"no quality, and the sensor says nothing",
       [](auto&, auto& traffic) {
         remove_if(traffic, [](const auto& entry) {
           return is_of(entry, "can0", 0x702) || is_of(entry, "can0", 0x201);
         });
       },
       Severity::error, "front: the sensor sends targets without quality on can0",
       "`cremed-doctor --configure-ars408 front`"},
      {"no quality, though the sensor claims it",
       [](auto&, auto& traffic) {
         remove_if(traffic, [](const auto& entry) { return is_of(entry, "can0", 0x702); });
       },
       Severity::error, "front: the sensor sends targets without quality on can0",
       "`cremed-doctor --configure-ars408 front`"},
      {"set to send nothing",
       [](auto&, auto& traffic) {
         remove_if(traffic, [](const auto& entry) { return entry.interface == "can0"; });
         say(traffic, [](auto& state) { state.output_code = 0; });
       },
       Severity::error, "front: the sensor is configured to send no targets (0x201)",
       "`cremed-doctor --configure-ars408 front`"},
      {"reports, but sends no targets",
       [](auto&, auto& traffic) {
         remove_if(traffic, [](const auto& entry) { return entry.interface == "can0"; });
         say(traffic, [](auto&) {});
       },
       Severity::error, "front: it reports its state but sends no targets",
       "`cremed-doctor --configure-ars408 front`"},
      {"a fault",
       [](auto&, auto& traffic) { say(traffic, [](auto& state) { state.voltage_error = true; }); },
       Severity::warning, "front: the sensor reports a fault: voltage error", "8 to 32 V"},
      {"some frames lost", [](auto&, auto& traffic) { lose_each(traffic, "can0", 0x702, 40); },
       Severity::warning, "scans are incomplete: their headers announce",
       "frames are lost on the way"},
      {"some frames of a GPR lost",
       [](auto&, auto& traffic) { lose_each(traffic, "can1", 0x210, 4); }, Severity::warning,
       "missing", "frames are lost on the way"},
      {"more clusters than fit on the bus", [](auto&, auto& traffic) { announce(traffic, 170); },
       Severity::error, "scans are incomplete: their headers announce",
       "`cremed-doctor --configure-ars408 front --max-distance 200`"},
      {"every scan lacks a frame", [](auto&, auto& traffic) { announce(traffic, 100); },
       Severity::error, "scans are incomplete", "frames are lost on the way"},
      {"wrong checksums",
       [](auto&, auto& traffic) {
         for (auto& entry : traffic) {
           std::uint8_t& checksum = entry.frame.data[7];
           checksum = static_cast<std::uint8_t>(~checksum);
         }
       },
       Severity::warning, "frames with a wrong checksum", "crc_policy = \"off\""},
      {"frames of the wrong length",
       [](auto&, auto& traffic) {
         CanFrame frame = traffic.front().frame;
         frame.id = 0x701;
         frame.length = 3;
         traffic.insert(traffic.begin() + 100, {"can0", frame});
       },
       Severity::warning, "front: 1 frame of the wrong length", "`candump -e any`"},
      {"too short to tell",
       [](auto&, auto& traffic) { remove_if(traffic, is_between(traffic, 0.06, 9.0)); },
       Severity::error, "front: no estimate yet", "--seconds"},
      {"silent for the last two thirds",
       [](auto&, auto& traffic) {
         remove_if(traffic, [is_late = is_between(traffic, 1.0, 9.0)](const auto& entry) {
           return entry.interface == "can0" && is_late(entry);
         });
       },
       Severity::error, "front: no scan in the last 2.", "loose contacts"},
      {"silent for a while",
       [](auto&, auto& traffic) {
         remove_if(traffic, [is_then = is_between(traffic, 0.5, 2.0)](const auto& entry) {
           return entry.interface == "can0" && is_then(entry);
         });
       },
       Severity::warning, "front: no scan from 0.", "loose contacts"},
      {"silent at first",
       [](auto&, auto& traffic) {
         remove_if(traffic, [is_early = is_between(traffic, 0.0, 1.8)](const auto& entry) {
           return entry.interface == "can0" && is_early(entry);
         });
       },
       Severity::warning, "front: no scan from 0.0 to 1.8 of ", "restarted"},
      {"silent but for a moment",
       [](auto&, auto& traffic) {
         remove_if(traffic, [is_early = is_between(traffic, 0.0, 2.85)](const auto& entry) {
           return entry.interface == "can0" && is_early(entry);
         });
       },
       Severity::warning, "front: no scan from 0.0 to 2.8 of ", "restarted"},
      {"two sensors with one id", [](auto&, auto& traffic) { add_twin(traffic, "can0", 36'000); },
       Severity::error,
       " lists a second from an ARS408 with sensor id 0 on can0, of one sensor 13 to 17: two "
       "sensors",
       "`cremed-doctor --configure-ars408 front --sensor-id 0`"},
      {"two GPRs with one base id",
       [](auto&, auto& traffic) { add_twin(traffic, "can1", 340'000); }, Severity::error,
       " lists a second from a Bosch GPR with base id 0x200 on can1, of one sensor 10: two sensors",
       "a bus of its own"},
      {"each frame twice",
       [](auto&, auto& traffic) {
         Recording twice;
         for (const auto& entry : traffic) {
           twice.insert(twice.end(), 2, entry);
         }
         traffic = twice;
       },
       Severity::error, "of one sensor 13 to 17: each frame comes twice", "gateway"},
      {"a clock that is set back",
       [](auto&, auto& traffic) {
         for (auto& entry : traffic) {
           entry.frame.stamp_us -= is_between(traffic, 1.5, 9.0)(entry) ? 3'600'000'000 : 0;
         }
       },
       Severity::warning, "the stamps of can0 run backwards 1 time, by up to 3", "timedatectl"},
      {"a clock that is set back often",
       [](auto&, auto& traffic) {
         for (std::size_t i = 0; i < traffic.size(); ++i) {
           traffic[i].frame.stamp_us -= static_cast<std::int64_t>(i / 2000) * 200'000;
         }
       },
       Severity::warning, "the stamps of can0 run backwards ", "timedatectl"},
      {"a GPR on its identifiers",
       [](auto& configuration, auto& traffic) {
         configuration.radars.resize(1);
         rename(traffic, "can1", "can0");
       },
       Severity::warning, "whose content contradicts the identifier", "a Bosch GPR?"},
      {"a GPR in its place, of which an identifier is missing",
       [](auto& configuration, auto& traffic) {
         configuration.radars.resize(1);
         remove_if(traffic, [](const auto& entry) {
           return entry.interface == "can0" || entry.frame.id == 0x234;
         });
         rename(traffic, "can1", "can0");
       },
       Severity::error,
       "front: frames on can0, but none of an ARS408 with sensor id 0: 0x100, 0x200, ", "type"},
  };
  return kAll;
}

/// The recording with a clock that is set forward at `at_s`.
Recording with_step(Recording traffic, double at_s, double step_s) {
  const auto is_after = is_between(traffic, at_s, 9.0);
  for (BusFrame& entry : traffic) {
    entry.frame.stamp_us += is_after(entry) ? std::llround(step_s * 1e6) : 0;
  }
  return traffic;
}

/// Three seconds of a healthy front radar.
void check_time_and_rate(const Configuration& configuration, const Observation& observation) {
  CHECK(observation.seconds == Approx(3.0).margin(0.2));
  CHECK_THAT(vital_signs(configuration.radars[0], observation.radars[0], observation.seconds),
             Catch::Matches("front: 1[34]\\.[0-9] scans/s, [34][0-9] estimates"));
}

}  // namespace

TEST_CASE("A healthy drive has no finding") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  report_state(traffic, "can0", good_state());
  const Observation observation = observe(configuration, traffic);
  CHECK(all_text(diagnose(configuration, observation)).empty());
  check_time_and_rate(configuration, observation);
}

TEST_CASE("A drive observed from the middle of a scan has no finding") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  traffic.erase(traffic.begin(), traffic.begin() + 77);
  traffic.erase(traffic.end() - 7, traffic.end());
  CHECK(all_text(diagnose(configuration, observe(configuration, traffic))).empty());
}

TEST_CASE("What is wrong with a radar is found") {
  Configuration healthy = demo_configuration();
  static const Recording kDrive = recording_of(healthy.radars);
  for (const Case& spoilt : cases()) {
    DYNAMIC_SECTION(spoilt.name) {
      Configuration configuration = healthy;
      Recording traffic = kDrive;
      spoilt.spoil(configuration, traffic);
      const auto findings = diagnose(configuration, observe(configuration, traffic));
      check_first(findings, spoilt.severity, spoilt.what, spoilt.remedy);
    }
  }
}

TEST_CASE("A radar at the mount of another is told which") {
  const Configuration configuration = demo_configuration();
  Observation observation = observe(configuration, recording_of(configuration.radars));
  RadarStatus& front = observation.radars[0].status;
  front.belief.doubts = other_radars_contradict;
  front.odometry = {.is_left_out = true, .cause = {FaultKind::exchanged, 0.0, 1}};
  CHECK_THAT(all_text(diagnose(configuration, observation)),
             Catch::Contains("front: it sees what a radar at the mount of rear sees"));
}

TEST_CASE("A doubt that does not explain it leaves a missing estimate an error") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  remove_if(traffic, is_between(traffic, 0.06, 9.0));
  Observation observation = observe(configuration, traffic);
  observation.is_live = true;
  observation.radars[0].status.belief.doubts = stamps_run_behind;
  CHECK_THAT(all_text(diagnose(configuration, observation)),
             Catch::Contains("front: no estimate yet"));
  observation.radars[0].status.belief.doubts = other_radars_contradict;
  CHECK_THAT(all_text(diagnose(configuration, observation)),
             !Catch::Contains("front: no estimate yet"));
}

TEST_CASE("A clock that is set back is not blamed on lost frames") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  for (std::size_t i = 0; i < traffic.size(); ++i) {
    traffic[i].frame.stamp_us -= static_cast<std::int64_t>(i / 1500) * 3'600'000'000;
  }
  const std::string text = all_text(diagnose(configuration, observe(configuration, traffic)));
  CHECK_THAT(text, Catch::Contains("run backwards"));
  CHECK_THAT(text, !Catch::Contains("lost"));
}

TEST_CASE("A clock that is set forward is told, and not blamed on supply and plug") {
  const double step_s = GENERATE(0.3, 3.0, 9.5, 15.0, 3600.0);
  const Configuration configuration = demo_configuration();
  const Recording traffic = recording_of(configuration.radars);
  const Observation observation = observe(configuration, with_step(traffic, 1.5, step_s));
  const auto findings = diagnose(configuration, observation);
  check_first(findings, Severity::warning,
              "the clock was set forward 1 time, by up to " + tenths(step_s) + " s", "timedatectl");
  CHECK(findings.size() == 1);
  check_time_and_rate(configuration, observation);
}

TEST_CASE("A pause beside a clock that was set is told too, and where it is without that") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  remove_if(traffic, [is_then = is_between(traffic, 1.7, 2.8)](const auto& entry) {
    return entry.interface == "can1" && is_then(entry);
  });
  const std::string text =
      all_text(diagnose(configuration, observe(configuration, with_step(traffic, 1.5, 5.0))));
  CHECK_THAT(text, Catch::Contains("the clock was set forward 1 time, by up to 5.0 s"));
  CHECK_THAT(text, Catch::Matches("(.|\n)*rear: no scan from 1\\.[67] to 2\\.[89] of [23](.|\n)*"));
  CHECK_THAT(text, !Catch::Contains("front:"));
}

TEST_CASE("Without a radar that counts on it is left open why no bus has a frame") {
  Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  configuration.radars = {configuration.radars[1], configuration.radars[1]};
  configuration.radars[0].name = "other";
  const auto paused = diagnose(configuration, observe(configuration, with_step(traffic, 1.5, 3.0)));
  check_first(paused, Severity::warning, "other: no scan from 1.", "its clock was set");
  Observation observation = observe(configuration, with_step(traffic, 1.5, 3600.0));
  observation.is_live = false;
  check_first(diagnose(configuration, observation), Severity::note,
              "the stamps of can1 leap forward by 3600.",
              "the clock was set, the recording paused");
}

TEST_CASE("Of several silences of all buses each is told as that, whichever is a radar's longest") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  const auto silence = [&](const char* interface, double begin_s, double end_s) {
    remove_if(traffic, [=, is_then = is_between(traffic, begin_s, end_s)](const auto& entry) {
      return entry.interface == interface && is_then(entry);
    });
  };
  silence("can0", 0.25, 1.45);
  silence("can1", 0.5, 1.45);
  silence("can0", 1.65, 2.75);
  silence("can1", 1.6, 2.75);
  const std::string text = all_text(diagnose(configuration, observe(configuration, traffic)));
  CHECK_THAT(text, Catch::Matches("(.|\n)*front: no scan from 0\\.[12] to 1\\.[45](.|\n)*"));
  CHECK_THAT(text, Catch::Matches("(.|\n)*rear: no scan from 1\\.[56] to 2\\.[78](.|\n)*"));
  CHECK_THAT(text, Catch::Contains("no bus has a frame then"));
  CHECK_THAT(text, !Catch::Contains("supply and plug"));
}

TEST_CASE("The rate of a radar that fell silent is that of the time before") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  remove_if(traffic, [is_late = is_between(traffic, 1.0, 9.0)](const auto& entry) {
    return entry.interface == "can0" && is_late(entry);
  });
  const Observation observation = observe(configuration, traffic);
  CHECK_THAT(vital_signs(configuration.radars[0], observation.radars[0], observation.seconds),
             Catch::Matches("front: 1[345]\\.[0-9] scans/s in 1\\.[01] of [23]\\.[0-9] s, "
                            "1[0-9] estimates"));
}

TEST_CASE("A log of more interfaces than a vehicle has is bounded, and the rest is told") {
  const Configuration configuration = demo_configuration();
  Observer observer(configuration);
  for (int i = 0; i < 100'000; ++i) {
    observer.add("i" + std::to_string(i), {.id = 0x123, .length = 8});
    observer.add_lost("l" + std::to_string(i), 1);
  }
  const Observation observation = observer.finish();
  CHECK(observation.buses.size() == kMaxBuses);
  CHECK(observation.frames_left_out > 199'000);
  CHECK_THAT(
      all_text(diagnose(configuration, observation)),
      Catch::Contains(" frames of further interfaces ignored: at most 64 interfaces are analysed"));
}

TEST_CASE("A radar that is somewhere else explains the silence of its bus") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  rename(traffic, "can0", "can7");
  CHECK(diagnose(configuration, observe(configuration, traffic)).size() == 1);
}

TEST_CASE("A radar that another of the configuration is missing is not offered to the wrong one") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  remove_if(traffic, [](const BusFrame& entry) { return entry.interface == "can1"; });
  rename(traffic, "can0", "can1");
  const auto findings = diagnose(configuration, observe(configuration, traffic));
  check_first(findings, Severity::error, "front: an ARS408 with sensor id 0 is on can1", "can1");
  CHECK_THAT(all_text(findings),
             Catch::Contains("rear: frames on can1, but none of a Bosch GPR with base id 0x200"));
}
