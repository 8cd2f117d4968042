// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/can_decoders/ars408_rows.hpp"

namespace cremed::test {
namespace {

TEST_CASE("0x600 heads a list of clusters") {
  const std::vector<Ars408Row<Ars408ClusterStatus>> rows = {
      {"600#5024581110", {80, 36, 22545, 1}},
      {"600#0000000010", {0, 0, 0, 1}},
      {"600#7D7DFFFF10", {125, 125, 65535, 1}},
      {"610#FF0A000110", {255, 10, 1, 1}},
  };
  check_rows<Ars408ClusterStatus>(rows);
}

TEST_CASE("0x701 holds a cluster's position, velocity and cross section") {
  const std::vector<Ars408Row<Ars408General>> rows = {
      {"701#004E81FC80200147", {0, 2.4, -0.7, 0.0, 0.0, Ars408DynProp::stationary, -28.5}},
      {"701#0000000000000000", {0, -500.0, -102.3, -128.0, -64.0, Ars408DynProp::moving, -64.0}},
      {"701#FFFFFFFFFFFFFFFF", {255, 1138.2, 102.3, 127.75, 63.75, Ars408DynProp::stopped, 63.5}},
      {"721#1155F9E172A0C291", {17, 50.2, -6.1, -13.5, 1.5, Ars408DynProp::oncoming, 8.5}},
      {"771#C86D625880200180", {200, 200.0, 17.7, 0.0, 0.0, Ars408DynProp::stationary, 0.0}},
  };
  check_rows<Ars408Cluster>(rows);
}

TEST_CASE("0x702 holds a cluster's quality") {
  const std::vector<Ars408Row<Ars408ClusterQuality>> rows = {
      {"702#0000000003", {0, {0, 0, 0, 0}, 0, Ars408InvalidState{0}, Ars408Ambiguity{3}}},
      {"722#116C155103", {17, {13, 16, 10, 21}, 1, Ars408InvalidState{0}, Ars408Ambiguity{3}}},
      {"702#FFFFFFF78C", {255, {31, 31, 31, 31}, 7, Ars408InvalidState{17}, Ars408Ambiguity{4}}},
      {"702#0508888671", {5, {1, 2, 4, 8}, 6, Ars408InvalidState{14}, Ars408Ambiguity{1}}},
      {"702#FFFFFFFFFF", {255, {31, 31, 31, 31}, 7, Ars408InvalidState{31}, Ars408Ambiguity{7}}},
  };
  check_rows<Ars408ClusterQuality>(rows);
}

TEST_CASE("0x60A heads a list of objects") {
  const std::vector<Ars408Row<Ars408ObjectStatus>> rows = {
      {"60A#03FBF710", {3, 64503, 1}}, {"60A#03FBF910", {3, 64505, 1}},
      {"60A#09EE9910", {9, 61081, 1}}, {"60A#64FFFF10", {100, 65535, 1}},
      {"61A#00000010", {0, 0, 1}},
  };
  check_rows<Ars408ObjectStatus>(rows);
}

TEST_CASE("0x60B holds an object's position, velocity and cross section") {
  const std::vector<Ars408Row<Ars408General>> rows = {
      {"60B#384F04028020019C", {56, 5.6, 0.6, 0.0, 0.0, Ars408DynProp::stationary, 14.0}},
      {"60B#204FEC00802001B4", {32, 11.4, 0.2, 0.0, 0.0, Ars408DynProp::stationary, 26.0}},
      {"60B#0050E3FD802001B7", {0, 17.6, -0.4, 0.0, 0.0, Ars408DynProp::stationary, 27.5}},
      {"60B#FFFFFFFFFFFFFFFF", {255, 1138.2, 204.8, 127.75, 63.75, Ars408DynProp::stopped, 63.5}},
      {"60B#0000000000000000", {0, -500.0, -204.6, -128.0, -64.0, Ars408DynProp::moving, -64.0}},
  };
  check_rows<Ars408Object>(rows);
}

TEST_CASE("0x60C holds an object's quality") {
  const std::vector<Ars408Row<Ars408ObjectQuality>> rows = {
      {"60C#3884A33A0220E8", {56, {16, 18, 17, 19}, 20, 0, 17, 7, Ars408MeasurementState{2}}},
      {"60C#2084633A0220E8", {32, {16, 17, 17, 19}, 20, 0, 17, 7, Ars408MeasurementState{2}}},
      {"60C#090888880F00AC", {9, {1, 2, 4, 8}, 16, 3, 24, 5, Ars408MeasurementState{3}}},
      {"60C#FFFFFFFFFFFFFF", {255, {31, 31, 31, 31}, 31, 31, 31, 7, Ars408MeasurementState{7}}},
  };
  check_rows<Ars408ObjectQuality>(rows);
}

}  // namespace
}  // namespace cremed::test
