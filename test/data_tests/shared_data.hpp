// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace cremed {

/// Path of a file in the folder of recorded data.
inline std::string shared_path(const std::string& name) {
  return std::string(std::getenv("CREMED_SHARED")) + "/" + name;
}

/// The content of a file there, unpacked if its name ends in .xz.
inline std::string read_shared(const std::string& name) {
  const std::string path = shared_path(name);
  if (!path.ends_with(".xz")) {
    std::ifstream file(path);
    if (!file) {
      throw std::runtime_error("cannot read " + path);
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  std::FILE* pipe = ::popen(("xz -dc '" + path + "'").c_str(), "r");
  std::string text;
  std::string block(1 << 16, '\0');
  for (std::size_t count = 1; count > 0;) {
    count = std::fread(block.data(), 1, block.size(), pipe);
    text.append(block, 0, count);
  }
  if (::pclose(pipe) != 0) {
    throw std::runtime_error("xz cannot unpack " + path);
  }
  return text;
}

}  // namespace cremed
