// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include "tools/eval/temporary_folder.hpp"

namespace cremed::test {

inline std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Result of running a program.
struct ToolRun {
  int status = 0;
  std::string output;
  std::string error;
};

/// Runs the program at this path; its output is stored in files of the folder.
inline ToolRun run_program(const std::string& path, const TemporaryFolder& folder,
                           const std::string& arguments) {
  const std::string command =
      path + " " + arguments + " >" + folder.file("stdout") + " 2>" + folder.file("stderr");
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), content(folder.file("stdout")), content(folder.file("stderr"))};
}

/// Runs a program of the build.
inline ToolRun run_tool(const std::string& name, const TemporaryFolder& folder,
                        const std::string& arguments) {
  return run_program(std::string(CREMED_BINARY_DIR) + "/bin/" + name, folder, arguments);
}

/// Cells of a printed table without its comments and column separators ("|").
inline std::vector<std::vector<std::string>> cells(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '#') continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) {
      if (word != "|") rows.back().push_back(word);
    }
  }
  return rows;
}

/// Arguments that a program refuses: its exit status, and a part of its message.
struct Refusal {
  std::string arguments;
  int status;
  std::string message;
};

/// `text` with a file's name at each place of its stand-in.
inline std::string with_file(std::string text, const std::string& stand_in,
                             const std::string& file) {
  for (std::size_t place = 0; (place = text.find(stand_in, place)) != std::string::npos;
       place += file.size()) {
    text.replace(place, stand_in.size(), file);
  }
  return text;
}

inline void check(const ToolRun& run, const Refusal& refusal) {
  CAPTURE(run.error);
  CHECK(run.status == refusal.status);
  CHECK_THAT(run.error, Catch::Contains(refusal.message));
}

}  // namespace cremed::test
