// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/source/line_reader.hpp"
#include "test/daemon/temporary_file.hpp"

using cremed::LineReader;
using cremed::TemporaryFile;

namespace {

std::vector<std::string> read_all(LineReader& reader) {
  std::vector<std::string> lines;
  std::string_view line;
  for (auto status = reader.next(line); status != LineReader::Status::end;
       status = reader.next(line)) {
    if (status == LineReader::Status::interrupted) {
      continue;
    }
    lines.emplace_back(status == LineReader::Status::line ? std::string(line) : "<too long>");
  }
  return lines;
}

}  // namespace

TEST_CASE("Lines come without their line feed, the last with or without one") {
  for (const std::string text : {"a\n\nbc\n", "a\n\nbc"}) {
    const TemporaryFile file(text);
    LineReader reader(file.path());
    CHECK(read_all(reader) == std::vector<std::string>{"a", "", "bc"});
    CHECK(reader.line_number() == 3);
  }
}

TEST_CASE("An empty file has no line, and its end stays the end") {
  const TemporaryFile file;
  LineReader reader(file.path());
  std::string_view line;
  CHECK(reader.next(line) == LineReader::Status::end);
  CHECK(reader.next(line) == LineReader::Status::end);
}

TEST_CASE("Lines that straddle the buffer's end arrive whole") {
  std::string text;
  std::vector<std::string> expected;
  for (int i = 0; i < 5000; ++i) {
    expected.push_back(std::to_string(i) + std::string(static_cast<std::size_t>(i % 97), 'x'));
    text += expected.back() + "\n";
  }
  const TemporaryFile file(text);
  LineReader reader(file.path());
  CHECK(read_all(reader) == expected);
}

TEST_CASE("A line longer than the buffer is passed over and the next is found") {
  for (const std::size_t length : {65536U, 65537U, 200000U}) {
    const TemporaryFile file("first\n" + std::string(length, 'z') + "\nlast\n");
    LineReader reader(file.path());
    CHECK(read_all(reader) == std::vector<std::string>{"first", "<too long>", "last"});
  }
}

TEST_CASE("Of a file that ends within a line longer than the buffer, that line is told") {
  for (const std::size_t length : {65536U, 65537U, 131072U}) {
    const TemporaryFile file("first\n" + std::string(length, '\0'));
    LineReader reader(file.path());
    CHECK(read_all(reader) == std::vector<std::string>{"first", "<too long>"});
    CHECK(reader.line_number() == 2);
  }
}

TEST_CASE("A file that cannot be opened is named with the reason") {
  CHECK_THROWS_WITH(LineReader("/nonexistent/log"),
                    Catch::Contains("/nonexistent/log") && Catch::Contains("No such file"));
}
