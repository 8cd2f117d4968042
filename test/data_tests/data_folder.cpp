// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace {

constexpr int kSkipped = 77;  // What CTest reports as skipped.

/// Recorded data is not part of the project. Without it the tests report that and end before Catch2
/// starts: a main of their own would double the compile time.
bool find_data() {
  if (std::getenv("CREMED_SHARED") == nullptr) {
    ::setenv("CREMED_SHARED", CREMED_SOURCE_DIR "/../shared", 1);
  }
  const char* folder = std::getenv("CREMED_SHARED");
  if (!std::filesystem::is_directory(std::filesystem::path(folder) / "data")) {
    std::printf("skipped: no recorded data in %s (CREMED_SHARED names the folder)\n", folder);
    std::exit(kSkipped);
  }
  return true;
}

[[maybe_unused]] const bool kHasData = find_data();

}  // namespace
