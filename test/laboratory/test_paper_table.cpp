// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "tools/laboratory/table/paper_table.hpp"

using namespace cremed;

namespace {

PaperTableOptions small(unsigned threads, std::uint64_t seed = 1) {
  return {.sets = 10, .runs = 3, .seed = seed, .threads = threads};
}

const TableRow& find(const std::vector<TableRow>& rows, std::string_view problem,
                     std::string_view method) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const TableRow& r) {
    return r.problem == problem && r.method == method;
  });
  REQUIRE(row != rows.end());
  return *row;
}

}  // namespace

TEST_CASE("The number of threads does not show in the table, the seed does") {
  const auto one = paper_table(small(1));
  const auto many = paper_table(small(4));
  REQUIRE(one.size() == many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CAPTURE(one[i].problem, one[i].method);
    CHECK(one[i].credibility.rmse_m() == many[i].credibility.rmse_m());
    CHECK(one[i].credibility.anees() == many[i].credibility.anees());
    CHECK(one[i].bound.rmse_deg == many[i].bound.rmse_deg);
    CHECK(one[i].iterations == many[i].iterations);
    CHECK(one[i].nees.counts() == many[i].nees.counts());
  }
  const auto other = paper_table(small(2, 2));
  CHECK(find(one, "PSR", "MSM").credibility.rmse_m() !=
        find(other, "PSR", "MSM").credibility.rmse_m());
}

TEST_CASE("Every problem has its methods, Doppler only where the paper has it") {
  const auto rows = paper_table(small(2));
  for (const char* problem : {"PSR", "PSR-C", "Sim", "Sim-C"}) {
    for (const char* method : {"MSM", "SA", "ICP"}) {
      const TableRow& row = find(rows, problem, method);
      CHECK(row.credibility.count() + row.left_out == 30);
      const auto& counts = row.nees.counts();
      CHECK(std::accumulate(counts.begin(), counts.end(), std::size_t{0}) ==
            row.credibility.count());
    }
    const bool has_doppler = std::string_view(problem).starts_with("Sim");
    CHECK(has_doppler == std::any_of(rows.begin(), rows.end(), [&](const TableRow& r) {
            return r.problem == problem && r.method == "MSM-D";
          }));
  }
  CHECK(find(rows, "PSR", "MSM").paper.rmse_m == 0.121);
  CHECK(find(rows, "Sim-C", "MSM-D").paper.anees == 1.09);
  CHECK(std::isnan(find(rows, "Sim", "ICP").paper.rmse_m));
  CHECK(find(rows, "Sim", "MSM-D").bound.rmse_m < 0.5 * find(rows, "Sim", "MSM").bound.rmse_m);
}

TEST_CASE("NEES far out of any chance goes to the last bin") {
  NeesHistogram histogram;
  for (const double nees :
       {0.0, 0.49, 0.5, 19.99, 20.0, 1e9, std::numeric_limits<double>::infinity()}) {
    histogram.add(nees);
  }
  CHECK(histogram.counts().at(0) == 2);
  CHECK(histogram.counts().at(1) == 1);
  CHECK(histogram.counts().at(39) == 1);
  CHECK(histogram.counts().at(40) == 3);
}
