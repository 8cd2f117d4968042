// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include <catch2/catch.hpp>

#include "daemon/output/text_line.hpp"

using cremed::TextLine;

TEST_CASE("Numbers are written as C does in the C locale") {
  TextLine line;
  line.integer(-42).text(",").fixed(1.5, 3).text(",").scientific(-0.00012345, 4);
  CHECK(line.view() == "-42,1.500,-1.2345e-04");
}

TEST_CASE("NaN is nan") {
  CHECK(TextLine().fixed(std::numeric_limits<double>::quiet_NaN(), 3).view() == "nan");
  CHECK(TextLine().scientific(std::numeric_limits<double>::quiet_NaN(), 3).view() == "nan");
}

TEST_CASE("What does not fit is cut off, never written past the end") {
  TextLine line;
  for (int i = 0; i < 300; ++i) {
    line.text("0123456789").integer(1234567890).fixed(1e300, 9);
  }
  CHECK(line.view().size() <= 1024);
  CHECK(line.view().substr(0, 20) == "01234567891234567890");
}
