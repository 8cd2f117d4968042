// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/eval/chi_square.hpp"

using cremed::anees_interval;

TEST_CASE("The interval of ANEES is that of printed chi-square tables") {
  struct Row {
    std::size_t count;
    int degrees_of_freedom;
    double low;  // quantiles 0.025 and 0.975 of count * degrees_of_freedom
    double high;
  };
  const auto row =
      GENERATE(Row{1, 2, 0.0506, 7.378}, Row{1, 3, 0.216, 9.348}, Row{5, 2, 3.247, 20.483},
               Row{10, 3, 16.791, 46.979}, Row{50, 2, 74.222, 129.561});
  CAPTURE(row.count, row.degrees_of_freedom);
  const double total = static_cast<double>(row.count) * row.degrees_of_freedom;
  const auto interval = anees_interval(row.count, row.degrees_of_freedom, 0.95);
  CHECK(interval.low * total == Approx(row.low).epsilon(1e-3));
  CHECK(interval.high * total == Approx(row.high).epsilon(1e-4));
}

TEST_CASE("The interval closes in on 1 as the square root of the number of estimates") {
  const auto interval = anees_interval(100000, 3, 0.95);
  CHECK(interval.high - 1.0 == Approx(1.96 * std::sqrt(2.0 / 300000.0)).epsilon(0.01));
  CHECK(1.0 - interval.low == Approx(1.96 * std::sqrt(2.0 / 300000.0)).epsilon(0.01));
  CHECK(std::isnan(anees_interval(0, 3, 0.95).low));
}
