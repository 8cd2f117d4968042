// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace cremed {

/// Opens a file ("-": standard input) and passes it to `read`; errors name the file.
template <typename Read>
auto with_input(const std::string& path, Read read) {
  std::ifstream file;
  if (path != "-") {
    file.open(path);
    if (!file) {
      throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
    }
  }
  try {
    return read(path == "-" ? std::cin : static_cast<std::istream&>(file));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

/// What a constructor makes of a file.
template <typename Content>
Content read_input(const std::string& path) {
  return with_input(path, [](std::istream& input) { return Content(input); });
}

/// All of it; for with_input().
inline std::string content(std::istream& input) {
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

}  // namespace cremed
