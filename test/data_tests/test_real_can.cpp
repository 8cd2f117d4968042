// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "daemon/source/candump.hpp"

namespace cremed::test {
namespace {

using Row = std::map<std::string, double>;

std::ifstream open_recording(const std::string& name) {
  const char* shared = std::getenv("CREMED_SHARED");
  REQUIRE(shared != nullptr);
  std::ifstream file(std::string(shared) + "/data/can/" + name);
  REQUIRE(file.is_open());
  return file;
}

std::vector<CanFrame> read_frames(const std::string& name) {
  std::vector<CanFrame> frames;
  std::ifstream file = open_recording(name);
  for (std::string line; std::getline(file, line);) {
    const CandumpLine parsed = parse_candump_line(line);
    REQUIRE(parsed.status == CandumpStatus::frame);
    frames.push_back(parsed.frame);
  }
  return frames;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(0, line.find('\r')));  // Lines end as in RFC 4180.
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

std::vector<Row> read_table(const std::string& name) {
  std::ifstream file = open_recording(name);
  std::string line;
  REQUIRE(std::getline(file, line));
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    REQUIRE(cells.size() == names.size());
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) {
      row[names[i]] = std::stod(cells[i]);
    }
  }
  return rows;
}

/// One object list, each block in the order of transmission.
struct ObjectList {
  std::int64_t stamp_us = 0;
  Ars408ObjectStatus status;
  std::vector<Ars408General> general{};
  std::vector<Ars408ObjectQuality> quality{};
};

std::vector<ObjectList> object_lists(const std::vector<CanFrame>& frames) {
  std::vector<ObjectList> lists;
  for (const CanFrame& frame : frames) {
    const Ars408Bytes bytes = std::span(frame.data).first(frame.length);
    if (frame.id == 0x60A) {
      lists.push_back(
          {.stamp_us = frame.stamp_us, .status = decode_ars408<Ars408ObjectStatus>(bytes).value()});
    } else if (frame.id == 0x60B) {
      lists.at(lists.size() - 1).general.push_back(decode_ars408<Ars408Object>(bytes).value());
    } else if (frame.id == 0x60C) {
      lists.at(lists.size() - 1)
          .quality.push_back(decode_ars408<Ars408ObjectQuality>(bytes).value());
    }
  }
  return lists;
}

/// The decoder's values in the columns and units of the table.
Row row_of(const ObjectList& list, std::size_t index) {
  const Ars408General& g = list.general.at(index);
  const Ars408ObjectQuality& q = list.quality.at(index);
  REQUIRE(q.id == g.id);
  return {{"t_header", static_cast<double>(list.stamp_us) * 1e-6},
          {"meas_counter", list.status.counter},
          {"n_obj", list.status.count},
          {"index", static_cast<double>(index)},
          {"id", g.id},
          {"dist_long", g.x_m},
          {"dist_lat", g.y_m},
          {"vrel_long", g.vx_mps},
          {"vrel_lat", g.vy_mps},
          {"dyn_prop", static_cast<double>(g.dyn_prop)},
          {"rcs", g.rcs_dbm2},
          {"dist_long_rms_idx", q.rms.x},
          {"dist_lat_rms_idx", q.rms.y},
          {"vrel_long_rms_idx", q.rms.vx},
          {"vrel_lat_rms_idx", q.rms.vy},
          {"arel_long_rms_idx", q.ax_rms_code},
          {"arel_lat_rms_idx", q.ay_rms_code},
          {"orientation_rms_idx", q.orientation_rms_code},
          {"prob_of_exist", q.existence_code},
          {"meas_state", static_cast<double>(q.measurement_state)}};
}

const std::string kObjects = "ars408_objects_miviacar_2026-06-24";

TEST_CASE("Every signal of a recorded object list is decoded", "[real]") {
  const std::vector<ObjectList> lists = object_lists(read_frames(kObjects + ".candump.log"));
  const std::vector<Row> rows = read_table(kObjects + ".decoded.csv");
  CHECK(lists.size() == 515);
  CHECK(rows.size() == 2996);
  std::size_t row = 0;
  for (const ObjectList& list : lists) {
    REQUIRE(list.general.size() == list.status.count);
    for (std::size_t index = 0; index < list.general.size(); ++index, ++row) {
      INFO("row " << row);
      const Row decoded = row_of(list, index);
      REQUIRE(decoded.size() + 6 == rows.at(row).size());  // dbc_test has the six of 0x60D.
      for (const auto& [name, value] : decoded) {
        INFO(name);
        CHECK(value == Approx(rows.at(row).at(name)).margin(1e-6).epsilon(0));
      }
    }
  }
  CHECK(row == rows.size());
}

TEST_CASE("Every recorded object list becomes a whole scan", "[real]") {
  const std::vector<CanFrame> frames = read_frames(kObjects + ".candump.log");
  const std::vector<Row> rows = read_table(kObjects + ".decoded.csv");
  REQUIRE(frames.size() == 9579);
  Ars408Decoder decoder({.output = Ars408Output::objects});
  ScanAssembler assembler(decoder, 50'000);
  std::size_t row = 0;
  for (const CanFrame& frame : frames) {
    assembler.add(decoder.decode(frame));
    while (const RadarScan* scan = assembler.next()) {
      CHECK(scan->status == ScanStatus::complete);
      CHECK(scan->stamp_us == std::llround(rows.at(row).at("t_header") * 1e6));
      CHECK(scan->announced == scan->count);
      for (std::size_t i = 0; i < scan->count; ++i, ++row) {
        CHECK(scan->counter == rows.at(row).at("meas_counter"));
        CHECK(scan->detections[i].id == rows.at(row).at("id"));
      }
    }
  }
  CHECK(row == 2996);

  const AssemblerCounters& scans = assembler.counters();
  CHECK(scans.scans == 515);
  CHECK(scans.incomplete_scans == 0);
  CHECK(scans.missed_scans == 0);
  CHECK(scans.orphan_parts + scans.duplicate_parts + scans.conflicting_parts == 0);
  CHECK(scans.stamps_backwards == 0);
  const DecoderCounters& counters = decoder.counters();
  CHECK(counters.frames == 9579);
  CHECK(counters.state_frames == 38 + 2996 + 38);
  CHECK(counters.wrong_length + counters.wrong_kind + counters.wrong_mode == 0);
  CHECK(decoder.radar_state().value().output_code == 1);
  CHECK(decoder.radar_state().value().speed_missing);
}

TEST_CASE("Two recorded cluster frames", "[real]") {
  const std::vector<CanFrame> frames = read_frames("ars408_cluster_two_frames.candump.log");
  REQUIRE(frames.size() == 2);
  Ars408Decoder decoder({});
  ScanAssembler assembler(decoder, 50'000);
  for (const CanFrame& frame : frames) {
    assembler.add(decoder.decode(frame));
  }
  const auto cluster = decode_ars408<Ars408Cluster>(frames[1].data).value();
  CHECK(cluster.x_m == Approx(2.4));
  CHECK(cluster.y_m == Approx(-0.7));
  CHECK(cluster.vx_mps == 0.0);
  CHECK(cluster.vy_mps == 0.0);
  CHECK(cluster.dyn_prop == Ars408DynProp::stationary);
  CHECK(cluster.rcs_dbm2 == -28.5);
  assembler.finish();
  const RadarScan* scan = assembler.next();
  REQUIRE(scan != nullptr);
  CHECK(scan->status == ScanStatus::missing_parts);
  CHECK(scan->counter == 22545);
  CHECK(scan->announced == 116);
  CHECK(assembler.counters().missing_parts == 2 * 116 - 1);
}

}  // namespace
}  // namespace cremed::test
