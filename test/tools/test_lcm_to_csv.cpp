// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/output/csv_writer.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/output/odometry_writer.hpp"
#include "test/tools/pipeline_bench.hpp"
#include "test/tools/tool_run.hpp"
#include "tools/eval/temporary_folder.hpp"
#include "tools/lcm_to_csv/lcm_to_csv.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// A drive with losses, so that all kinds of rows occur, published into an LCM log and written as
/// CSV.
void record_drive(const std::string& log, const std::string& csv, const std::string& odometry) {
  const std::vector<RadarConfiguration> radars = default_radars();
  SimulationOptions options;
  options.duration_s = 8.0;
  const Drive simulated = drive(scenario("lossy"), radars, options);
  LcmPublisher publisher(log, configuration_of(radars));
  REQUIRE(publisher.connect().empty());
  CsvWriter writer(csv, {"front", "rear"});
  OdometryWriter odometry_writer(odometry);
  const PipelineClock clock{[] {
    static std::int64_t now_us = 0;
    return now_us += 17;
  }};
  Pipeline pipeline(configuration_of(radars), kNoSource, {&publisher, &writer, &odometry_writer},
                    clock);
  play(simulated.frames, pipeline);
  REQUIRE(publisher.failures() + writer.failures() == 0);
}

ego_motion_t message() {
  ego_motion_t result{};
  result.utime = 2;
  result.utime_start = 1;
  result.source = "front";
  return result;
}

std::vector<std::uint8_t> encoded_motion(const ego_motion_t& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

void write_motions(const std::string& path, const std::vector<std::uint8_t>& bytes,
                   const std::string& channel = "CREMED_EGO_MOTION") {
  lcm::LogFile log(path, "w");
  for (std::vector<std::uint8_t> data : {encoded_motion(message()), bytes}) {
    lcm::LogEvent event{};
    event.channel = channel;
    event.datalen = static_cast<int>(data.size());
    event.data = data.data();
    REQUIRE(log.writeEvent(&event) == 0);
  }
}

struct Converted {
  LcmLogCounters counters;
  std::string csv;
};

Converted convert(const std::string& path) {
  LineFile csv(path + ".csv");
  const LcmLogCounters counters = lcm_to_csv(path, csv);
  csv.finish();
  return {counters, content(path + ".csv")};
}

}  // namespace

TEST_CASE("An LCM log becomes the CSV that the daemon would have written, byte for byte") {
  const TemporaryFolder folder;
  const std::string log = folder.file("drive.lcm");
  record_drive("file://" + log + "?mode=w", folder.file("direct.csv"),
               folder.file("direct-odometry.csv"));
  const Converted converted = convert(log);
  CHECK(converted.csv == content(folder.file("direct.csv")));
  CHECK(converted.counters.motions > 150);
  CHECK(converted.counters.bad_messages == 0);
  CHECK(converted.counters.damage.empty());

  const ToolRun run = run_tool("cremed-lcm-to-csv", folder,
                               log + " --output " + folder.file("tool.csv") + " --odometry " +
                                   folder.file("tool-odometry.csv"));
  CHECK(run.status == 0);
  CHECK(run.error.empty());
  CHECK(content(folder.file("tool.csv")) == converted.csv);
  const std::string odometry = content(folder.file("tool-odometry.csv"));
  CHECK(odometry == content(folder.file("direct-odometry.csv")));
  CHECK(std::ranges::count(odometry, '\n') > 100);
}

TEST_CASE("Messages that are none of ours are left out and counted") {
  struct Row {
    const char* what;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<std::uint8_t> other_type = encoded_motion(message());
  other_type[0] ^= 1U;
  std::vector<std::uint8_t> cut = encoded_motion(message());
  cut.pop_back();
  std::vector<std::uint8_t> longer = encoded_motion(message());
  longer.push_back(0);
  std::vector<std::uint8_t> no_string = encoded_motion(message());
  constexpr std::size_t kLowByteOfSourceLength = 8 + 3 * 8 + 3;
  no_string[kLowByteOfSourceLength] = 0;
  ego_motion_t unknown_status = message();
  unknown_status.status = 11;
  ego_motion_t two_columns = message();
  two_columns.source = "front,rear";
  const std::vector<Row> rows = {{"another fingerprint", other_type},
                                 {"cut off", cut},
                                 {"too long", longer},
                                 {"empty", {}},
                                 {"string of no length", no_string},
                                 {"unknown status", encoded_motion(unknown_status)},
                                 {"a name that breaks the row", encoded_motion(two_columns)}};
  const TemporaryFolder folder;
  for (const Row& row : rows) {
    CAPTURE(row.what);
    write_motions(folder.file("log"), row.bytes);
    const Converted converted = convert(folder.file("log"));
    CHECK(converted.counters.motions == 1);
    CHECK(converted.counters.bad_messages == 1);
    CHECK(std::ranges::count(converted.csv, '\n') == 2);
    const ToolRun run = run_tool("cremed-lcm-to-csv", folder, folder.file("log"));
    CHECK(run.status == 1);
    CHECK(run.output == converted.csv);
    CHECK(run.error.find("ignored 1 messages") != std::string::npos);
  }
}

TEST_CASE("A log that cannot be good is a failure that says why") {
  const TemporaryFolder folder;
  const std::string log = folder.file("log");
  const auto error_of = [&](const std::string& arguments, int status) {
    const ToolRun run = run_tool("cremed-lcm-to-csv", folder, arguments);
    CHECK(run.status == status);
    return run.error;
  };
  CHECK(error_of("/no/such.lcm", 1).find("cannot read /no/such.lcm") != std::string::npos);
  CHECK(error_of("", 2).find("LOG is required") != std::string::npos);
  write_motions(log, encoded_motion(message()), "CREMED_STATUS");
  CHECK(error_of(log, 1).find("no motion") != std::string::npos);
  write_motions(log, encoded_motion(message()));
  CHECK(error_of(log, 0).empty());
  CHECK(error_of(log + " --output " + log, 2).find("name another file") != std::string::npos);
  CHECK(error_of(log + " --odometry " + log, 2).find("name another file") != std::string::npos);
  CHECK(error_of(log + " --odometry -", 2).find("are one file") != std::string::npos);
  CHECK(error_of(log + " --odometry " + folder.file("o.csv"), 1).find("no odometry") !=
        std::string::npos);
  CHECK(error_of(log + " --output /no/such/a.csv", 1).find("cannot write") != std::string::npos);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 1);
  CHECK(error_of(log, 1).find("ends inside a message") != std::string::npos);
}

TEST_CASE("Of a damaged log what comes before is converted, and where the damage is, is said") {
  struct Row {
    const char* what;
    std::size_t offset;  // In the second message's header.
    std::uint32_t value;
    const char* told;
  };
  const std::vector<Row> rows = {
      {"no message", 0, 0, ": damaged at byte 200: no message begins there"},
      {"channel", 20, 0x7FFFFFFF,
       ": damaged at byte 200: the message there has impossible lengths"},
      {"negative", 24, 0xFFFFFFF0,
       ": damaged at byte 200: the message there has impossible lengths"},
      {"data", 24, 0x7FFFFFF0, ": damaged at byte 200: the message there has impossible lengths"},
      {"beyond the end", 24, 0x0FFFFFFF, ": ends inside a message, which begins at byte 200"}};
  const TemporaryFolder folder;
  const std::string log = folder.file("log");
  write_motions(log, encoded_motion(message()));
  const std::string good = content(log);
  const std::size_t second = good.size() / 2;
  for (const Row& row : rows) {
    CAPTURE(row.what);
    std::string damaged = good;
    for (std::size_t i = 0; i < 4; ++i) {
      damaged[second + row.offset + i] = static_cast<char>(row.value >> (24 - 8 * i));
    }
    std::ofstream(log, std::ios::binary) << damaged;
    const ToolRun run = run_tool("cremed-lcm-to-csv", folder, log);
    CHECK(run.status == 1);
    CHECK(std::ranges::count(run.output, '\n') == 2);
    std::string told = log + row.told;
    told.replace(told.find("200"), 3, std::to_string(second));
    CHECK(run.error.find(told) != std::string::npos);
  }
}
