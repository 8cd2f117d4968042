// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <catch2/catch.hpp>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "daemon/report/condition_log.hpp"

using namespace cremed;

TEST_CASE("A condition is logged when it begins, when it turns into another, and when it ends") {
  std::ostringstream text;
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_st>(text)));
  spdlog::set_pattern("%l %v");
  ConditionLog log;
  int asked = 0;
  const auto look = [&](const char* subject, int kind) {
    log.update(subject, kind, [&] {
      ++asked;
      return "kind " + std::to_string(kind);
    });
  };
  for (const int kind : {0, 0, 1, 1, 1, 2, 2, 0, 0, 1}) {
    look("can0", kind);
    look("can1", 0);
  }
  CHECK(text.str() ==
        "warning can0: kind 1\nwarning can0: kind 2\ninfo can0: good again\n"
        "warning can0: kind 1\n");
  CHECK(asked == 3);
}
