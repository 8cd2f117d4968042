// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration_path.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/process/plain_text.hpp"
#include "test/tools/own_network.hpp"
#include "test/tools/tool_run.hpp"
#include "tools/doctor/live_observation.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

const std::string kData = CREMED_SOURCE_DIR "/test/data/";
const std::string kBends = "--config " + kData + "bends.toml --replay ";

ToolRun doctor(const TemporaryFolder& folder, const std::string& arguments) {
  return run_tool("cremed-doctor", folder, arguments);
}

/// The log bends.log, or the output of a shell filter on it.
ToolRun doctor_of_filtered(const TemporaryFolder& folder, const std::string& filter,
                           const std::string& options = "") {
  const std::string log = folder.file("log");
  REQUIRE(std::system((filter + " <" + kData + "bends.log >" + log).c_str()) == 0);
  return doctor(folder, kBends + log + options);
}

}  // namespace

TEST_CASE("cremed-doctor: a healthy log has no finding") {
  const TemporaryFolder folder;
  const ToolRun result = doctor(folder, kBends + kData + "bends.log");
  CHECK(result.status == 0);
  CHECK_THAT(result.output, Catch::StartsWith("good: front: 13."));
  CHECK_THAT(result.output, Catch::Contains("\ngood: rear: 10."));
  CHECK_THAT(result.output, Catch::Contains(" estimates\n"));
}

TEST_CASE("cremed-doctor: findings are one a line, the status says that there are some") {
  const TemporaryFolder folder;
  const ToolRun silent = doctor_of_filtered(folder, "grep -v ' can0 '");
  CHECK(silent.status == 1);
  CHECK_THAT(silent.output,
             Catch::StartsWith("error: the log has no frame of interface can0; record that bus "
                               "too, or set interface to one of these: can1\nfront: 0.0 scans/s, "
                               "0 estimates\nrear: 10."));
  const ToolRun shifted = doctor_of_filtered(folder, "sed 's/ can0 \\([267]\\)0/ can0 \\12/'");
  CHECK(shifted.status == 1);
  CHECK_THAT(shifted.output, Catch::StartsWith("error: front: not an ARS408 with sensor id 0 but "
                                               "an ARS408 with sensor id 2 is on can0; set "));
  const ToolRun lossy =
      doctor(folder, "--config " + kData + "lossy.toml --replay " + kData + "lossy.log");
  CHECK(lossy.status == 1);
  CHECK_THAT(lossy.output, Catch::StartsWith("warning: front: 8 of 41 scans are incomplete"));
}

TEST_CASE("cremed-doctor: a log of a scan or two blames nobody") {
  const TemporaryFolder folder;
  const auto lines = GENERATE("20", "100", "400");
  const ToolRun cut = doctor_of_filtered(folder, "head -" + std::string(lines));
  CHECK(cut.status == 1);
  CHECK_THAT(cut.output, Catch::StartsWith("error: the log lasts less than half a second: too "
                                           "short to tell anything; record 10 s or more\nfront: "));
}

TEST_CASE("cremed-doctor: a log shows the interfaces that are to be found") {
  const TemporaryFolder folder;
  const auto changed = [&](const std::string& change) {
    REQUIRE(std::system(
                ("sed '" + change + "' " + kData + "bends.toml >" + folder.file("toml")).c_str()) ==
            0);
    return doctor(folder, "--config " + folder.file("toml") + " --replay " + kData + "bends.log");
  };
  const ToolRun found = changed("s/^interface = .*/interface = \"auto\"/");
  CHECK(found.status == 0);
  CHECK_THAT(found.output, Catch::StartsWith("good: front: 13."));
  CHECK_THAT(found.output, Catch::Contains("\ngood: rear: 10."));
  const ToolRun absent = changed("0,/^interface = .*/s//interface = \"auto\"\\nsensor_id = 4/");
  CHECK(absent.status == 1);
  CHECK_THAT(absent.output,
             Catch::StartsWith("error: front: no CAN interface shows an ARS408 with sensor id 4 "
                               "(can0: an ARS408 with sensor id 0; can1: a Bosch GPR with base id "
                               "0x200); check "));
  CHECK_THAT(absent.output, Catch::Contains("\nrear: 10."));
}

TEST_CASE("cremed-doctor: a log of each bus is as one of all") {
  const TemporaryFolder folder;
  for (const std::string bus : {"can0", "can1"}) {
    const std::string own = "grep ' " + bus + " ' " + kData + "bends.log >" + folder.file(bus);
    REQUIRE(std::system(own.c_str()) == 0);
  }
  const std::string both =
      "--replay " + folder.file("can1") + " --replay " + folder.file("can0") + " ";
  for (const std::string& what :
       {"--json --config " + kData + "bends.toml", std::string("--suggest-config")}) {
    const ToolRun whole = doctor(folder, what + " --replay " + kData + "bends.log");
    const ToolRun merged = doctor(folder, both + what);
    CHECK(merged.status == 0);
    CHECK(merged.output == whole.output);
  }
  std::ofstream(folder.file("empty"));
  CHECK(doctor(folder,
               both + "--replay " + folder.file("empty") + " --config " + kData + "bends.toml")
            .status == 0);
  check(doctor(folder, "--replay " + folder.file("empty") + " --replay " + folder.file("none") +
                           " --config " + kData + "bends.toml"),
        {"", 1, folder.file("none")});
}

TEST_CASE("cremed-doctor: lost frames that the log itself reports") {
  const TemporaryFolder folder;
  const ToolRun result = doctor_of_filtered(
      folder, "sed \"100i DROPCOUNT: dropped 9 CAN frames on 'can0' socket (total drops 9)\"");
  CHECK(result.status == 1);
  CHECK_THAT(result.output, Catch::StartsWith("warning: 9 frames of can0 lost before"));
  const ToolRun of_any = doctor_of_filtered(
      folder, "sed \"100i DROPCOUNT: dropped 9 CAN frames on 'any' socket (total drops 9)\"");
  CHECK(of_any.status == 1);
  CHECK_THAT(of_any.output, Catch::StartsWith("warning: 9 frames lost before they were read, of "));
}

TEST_CASE("cremed-doctor: LCM is checked with a log only if asked for") {
  const TemporaryFolder folder;
  if (test::enter_own_network()) {
    const std::string url = " --lcm-url 'udpm://239.1.2.3:7667'";
    const ToolRun result = doctor_of_filtered(folder, "cat", url);
    CHECK(result.status == 1);
    CHECK_THAT(result.output,
               Catch::StartsWith("error: LCM cannot send; Network is unreachable. "));
  }
  CHECK(doctor_of_filtered(folder, "cat", " --lcm-url none").status == 0);
}

TEST_CASE("cremed-doctor: the diagnosis as JSON") {
  const TemporaryFolder folder;
  const ToolRun well = doctor_of_filtered(folder, "cat", " --json");
  CHECK(well.status == 0);
  CHECK_THAT(well.output, Catch::StartsWith("{\n  \"good\": true,\n  \"seconds\": "));
  CHECK_THAT(well.output, Catch::Contains("\"findings\": [],"));
  CHECK_THAT(well.output, Catch::Contains("\"radar\": \"front\""));
  const ToolRun silent = doctor_of_filtered(folder, "grep -v ' can0 '", " --json");
  CHECK(silent.status == 1);
  CHECK_THAT(silent.output, Catch::StartsWith("{\n  \"good\": false,"));
  CHECK_THAT(silent.output,
             Catch::Contains(
                 "\"severity\": \"error\",\n      \"what\": \"the log has no frame of "
                 "interface can0\",\n      \"remedy\": \"record that bus too, or set interface to "
                 "one of these: can1\""));
}

TEST_CASE("cremed-doctor suggests a configuration, which is refused until it is filled in") {
  const TemporaryFolder folder;
  const ToolRun suggested = doctor(folder, "--suggest-config " + kData + "bends.log");
  CAPTURE(suggested.error);
  REQUIRE(suggested.status == 0);
  std::ofstream(folder.file("first.toml")) << suggested.output;
  const std::string use = " --config " + folder.file("first.toml") + " --replay " + kData;
  const ToolRun empty = doctor(folder, use + "bends.log");
  CHECK(empty.status == 2);
  CHECK_THAT(empty.error, Catch::Contains("radar.mount.x_m: is \"FILL IN\"; must be a number"));
  REQUIRE(std::system(("sed -i 's/\"FILL IN\"/0.1/' " + folder.file("first.toml")).c_str()) == 0);
  CHECK_THAT(doctor(folder, use + "bends.log").output, Catch::Contains("radar2: 10."));
  const ToolRun nothing = doctor(folder, "--suggest-config /dev/null");
  CHECK(nothing.status == 1);
  CHECK(nothing.output.empty());
}

TEST_CASE("cremed-doctor examines a log without any configuration, and says how to write one") {
  if (!is_unwritten()) {
    WARN("skipped: this computer has a configuration of cremed");
    return;
  }
  const TemporaryFolder folder;
  const ToolRun well = doctor(folder, "--replay " + kData + "bends.log");
  CHECK(well.status == 0);
  CHECK_THAT(well.output, Catch::StartsWith("note: there is no configuration, ") &&
                              Catch::Contains(std::string(kWriteFirst)) &&
                              Catch::Contains("\ngood: radar1: 13.") &&
                              Catch::Contains("\ngood: radar2: 10."));
  const ToolRun lossy = doctor(folder, "--replay " + kData + "lossy.log");
  CHECK(lossy.status == 1);
  CHECK_THAT(lossy.output, Catch::StartsWith("warning: radar1: 8 of 41 scans are incomplete"));
  std::ofstream(folder.file("other.log")) << "(1.000000) can0 7FF#00\n(2.000000) can0 7FF#00\n";
  check(doctor(folder, "--replay " + folder.file("other.log")),
        {"", 1, "can0: frames, but none of a radar (0x7FF)"});
  check(doctor(folder, "--replay - <" + kData + "bends.log"),
        {"", 2, "a pipe cannot be read twice"});
}

TEST_CASE("cremed-doctor takes the log to suggest from with either option") {
  const TemporaryFolder folder;
  const std::string log = kData + "bends.log";
  const ToolRun expected = doctor(folder, "--suggest-config " + log);
  REQUIRE(expected.status == 0);
  const auto arguments =
      GENERATE_COPY("--replay " + log + " --suggest-config", "--suggest-config --replay " + log,
                    "--suggest-config - <" + log, "--replay - --suggest-config <" + log);
  const ToolRun suggested = doctor(folder, arguments);
  CAPTURE(arguments, suggested.error);
  CHECK(suggested.status == 0);
  CHECK(suggested.output == expected.output);
}

TEST_CASE("cremed-doctor: nothing of a log or a name is a command to the terminal") {
  const TemporaryFolder folder;
  const std::string evil = "e\x1B]0;x\x07\x9B\xC2\x9B\x7F";
  std::ofstream(folder.file("log"))
      << "(1.000000) can7 123#00\n(2.000000) " << evil << " 123#00\n(2.000000) can7 123#00\n";
  const std::string config = "--config " + kData + "bends.toml ";
  for (const std::string& arguments :
       {config + "--replay " + folder.file("log"), "--suggest-config " + folder.file("log"),
        config + "--json --replay " + folder.file("log"), config + "--replay '" + evil + "'",
        "--config '" + evil + "'", config + "--configure-ars408 '" + evil + "'",
        config + "'--" + evil + "'", config + "--lcm-url '" + evil + "'"}) {
    CAPTURE(arguments);
    const ToolRun result = doctor(folder, arguments);
    CHECK(result.status != 0);
    const std::string all = result.output + result.error;
    CHECK(plain_text(all) == all);
    CHECK_THAT(all, Catch::Contains("e?]0;x") || Catch::Contains("can7"));
  }
}

TEST_CASE("cremed-doctor says what is wrong with its arguments") {
  const std::string config = "--config " + kData + "bends.toml ";
  const auto row = GENERATE_COPY(
      Refusal{"--nonsense", 2, "--nonsense"}, Refusal{"--seconds 0", 2, "--seconds"},
      Refusal{"--config /no/such/file.toml", 2, "/no/such/file.toml: cannot be read"},
      Refusal{config + "--lcm-url me", 2, "--lcm-url: 'me' is not"},
      Refusal{config + "--lcm-url 'udpm://239.255.76.67:7667?ttl=256'", 2, "ttl of 0 to 255"},
      Refusal{config + "--lcm-url udpm://1.2.3.4:7667", 2, "with a group of 224.0.0.0 to "},
      Refusal{config + "--lcm-url tcpq://127.0.0.1:7700", 2, "is not \"none\" or a URL such as"},
      Refusal{config + "--yes", 2, "--sensor-id and --yes need --configure-ars408 or"},
      Refusal{config + "--sensor-id 3", 2, "--sensor-id and --yes need --configure-ars408 or"},
      Refusal{config + "--configure-ars408 '' --yes", 2, "must be the name of a radar"},
      Refusal{config + "--ars408-filters '' --yes", 2, "must be the name of a radar"},
      Refusal{config + "--configure-ars408 front --sensor-id 8", 2, "--sensor-id"},
      Refusal{config + "--configure-ars408 front --ars408-filters front", 2, "--ars408-filters"},
      Refusal{config + "--ars408-filters front --filter rcs=5", 2,
              "--filter: 'rcs=5' is not NAME=MIN"},
      Refusal{config + "--filter rcs=off", 2, "--ars408-filters"},
      Refusal{config + "--suggest-config live", 2, "--suggest-config"},
      Refusal{"--suggest-config live --json", 2, "--json"},
      Refusal{"--suggest-config /no/such/log", 1, "/no/such/log"},
      Refusal{"--suggest-config --replay /no/such/log", 1, "/no/such/log"},
      Refusal{"--suggest-config a.log --replay b.log", 2, "name a log each: leave one out"},
      Refusal{config + "--store", 2, "--configure-ars408"},
      Refusal{config + "--max-distance 250", 2, "--configure-ars408"},
      Refusal{config + "--configure-ars408 front --max-distance 20", 2, "--max-distance"},
      Refusal{config + "--configure-ars408 front --replay x", 2, "--replay"},
      Refusal{config + "--configure-ars408 rear", 2,
              "'rear' is not an ARS408 of the configuration, "
              "which has front"},
      Refusal{kBends + "/no/such/log", 1, "/no/such/log"},
      Refusal{kBends + "/dev/null", 1, "no CAN frame in it; lines of `candump -L` are expected"});
  CAPTURE(row.arguments);
  const TemporaryFolder folder;
  check(doctor(folder, row.arguments), row);
}

TEST_CASE(
    "cremed-doctor tells of lines that are none of candump, but not of a log that was cut off") {
  const TemporaryFolder folder;
  const ToolRun spoilt = doctor_of_filtered(folder, "sed '100~50s/^(/x/'");
  CHECK(spoilt.status == 1);
  CHECK_THAT(spoilt.output,
             Catch::Contains(": a frame's line must begin with (seconds.fraction) (") &&
                 Catch::Contains("they are left out"));
  CHECK(doctor_of_filtered(folder, "head -c -12").status == 0);
  CHECK(doctor_of_filtered(folder, "head -c -3").status == 0);  // A shorter frame.
}

TEST_CASE("cremed-doctor on a computer without these interfaces") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("absent.toml"))
      << "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"cremed-absent\"\n"
         "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.0 }\n";
  const std::string config = "--config " + folder.file("absent.toml");
  const ToolRun result = doctor(folder, config + " --seconds 0.1 --lcm-url none");
  CHECK(result.status == 1);
  CHECK_THAT(result.output,
             Catch::StartsWith(kernel_has_can() ? "error: there is no interface cremed-absent; "
                                                : "error: the kernel has no CAN sockets; "));
  const ToolRun setup = doctor(folder, config + " --configure-ars408 front --yes");
  CHECK(setup.status == 1);
  CHECK_THAT(setup.output, Catch::StartsWith("error: there is no interface cremed-absent; "));
}
