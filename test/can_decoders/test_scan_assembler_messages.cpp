// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Families with one message, or more than two, per target.
#include <string>
#include <vector>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

TEST_CASE("One message is a whole target") {
  const std::vector<ScanRow> rows = {
      {"in any order", "h7/3 f2=12 f0=10 !0 f1=11", {"7/3 complete 2=12 0=10 1=11"}},
      {"a lost one is one missing part",
       "h1/2 f0 h2/0",
       {"1/2 missing_parts 0", "2/0 complete"},
       {.missing_parts = 1}},
      {"a lost header does not lose the scan",
       "h1/0 +70000 f1=5 f2=6 .",
       {"1/0 complete", "2/2 missing_parts 1=5 2=6"},
       {.headerless_scans = 1}},
      {"a message that targets of the family do not have is ignored",
       "h1/1 s0 m255:0 !0 f0",
       {"1/1 complete 0"}},
  };
  check_scripts({.has_header = true, .messages = 1}, rows);
  check_scripts({.has_header = false, .counter_modulus = 4, .slot_count = 2, .messages = 1},
                {{"without header", "c3 f0-1 c0 f0", {"3/2 complete 0 1"}}});
}

TEST_CASE("More messages than two make a target, in any order") {
  check_scripts({.has_header = true, .messages = 4},
                {{"four",
                  "h1/2 m0:9=20 m2:9=22 m1:9=21 m3:9=23 m2:9=22 m0:4 m1:4 m2:4 !0 m3:4",
                  {"1/2 complete 9=20,23 4"},
                  {.duplicate_parts = 1, .reordered_parts = 1}}});
  check_scripts({.has_header = true, .messages = 3}, {{"what is missing is counted by messages",
                                                       "h1/2 m0:0 m1:0 .",
                                                       {"1/2 missing_parts"},
                                                       {.missing_parts = 4}}});
}

TEST_CASE("More messages than fit are as many as fit") {
  ScanBench bench({.has_header = true, .messages = 200});
  bench.play("h1/1");
  for (std::size_t number = 0; number < kMaxMessages; ++number) {
    bench.play("m" + std::to_string(number) + ":0");
  }
  CHECK(bench.scans.size() == 1);
}

}  // namespace
}  // namespace cremed::test
