// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>

#include <catch2/catch.hpp>

#include "test/data_tests/shared_data.hpp"
#include "test/tools/readme_rows.hpp"
#include "tools/laboratory/table/drive_table.hpp"

using namespace cremed;

namespace {

/// Half a unit of its last digit may round either way on another processor.
bool is_same_number(const std::string& a, const std::string& b) {
  char* end = nullptr;
  const double value = std::strtod(a.c_str(), &end);
  const std::size_t point = a.find('.');
  if (end == a.c_str() || point != b.find('.') || a.size() != b.size()) {
    return a == b;
  }
  const std::size_t number = static_cast<std::size_t>(end - a.c_str());
  const double unit =
      point == std::string::npos
          ? 1.0
          : std::pow(10.0, static_cast<double>(point + 1) - static_cast<double>(number));
  return a.substr(number) == b.substr(static_cast<std::size_t>(number)) &&
         std::abs(value - std::strtod(b.c_str(), nullptr)) < 1.01 * unit;
}

bool is_same_cell(const std::string& a, const std::string& b) {
  std::istringstream words_a(a);
  std::istringstream words_b(b);
  std::string word_a;
  std::string word_b;
  while (words_a >> word_a) {
    if (!(words_b >> word_b) || !is_same_number(word_a, word_b)) {
      return false;
    }
  }
  return !(words_b >> word_b);
}

}  // namespace

// On a difference: `cremed-eval table --drives FOLDER --write` in the project's folder.
TEST_CASE("Real drives: the README's tables are what the command measures") {
  const unsigned threads = std::max(std::thread::hardware_concurrency(), 1U);
  std::ifstream file(std::string(CREMED_SOURCE_DIR) + "/" + kReadmeWithTables);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  for (const ReadmeTable& table : drive_tables({shared_path("data"), CREMED_SOURCE_DIR, threads})) {
    CAPTURE(table.name);
    const auto written = test::rows_in(text, table.name);
    REQUIRE(written);
    REQUIRE(written->size() == table.rows.size());
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      REQUIRE((*written)[row].size() == table.rows[row].size());
      for (std::size_t i = 0; i < table.rows[row].size(); ++i) {
        CAPTURE(table.rows[row][0], table.header[i], (*written)[row][i], table.rows[row][i]);
        CHECK(is_same_cell((*written)[row][i], table.rows[row][i]));
      }
    }
  }
}
