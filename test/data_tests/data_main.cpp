// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#define CATCH_CONFIG_RUNNER
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>

// Recorded data is not part of the project. Where it is not at hand the tests say so and skip
// (exit status 77, which CTest reports as skipped).
int main(int argc, char** argv) {
  if (std::getenv("CREMED_SHARED") == nullptr) {
    ::setenv("CREMED_SHARED", CREMED_SOURCE_DIR "/../shared", 1);
  }
  const char* folder = std::getenv("CREMED_SHARED");
  if (!std::filesystem::is_directory(std::filesystem::path(folder) / "data")) {
    std::printf("skipped: no recorded data in %s (CREMED_SHARED names the folder)\n", folder);
    return 77;
  }
  return Catch::Session().run(argc, argv);
}
