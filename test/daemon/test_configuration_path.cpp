// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_path.hpp"

namespace cremed {
namespace {

const std::string kThere = CREMED_SOURCE_DIR "/config/demo.toml";
const std::string kAbsent = CREMED_BINARY_DIR "/absent/cremed.toml";

TEST_CASE("the file that is named comes first, be it there or not") {
  CHECK(configuration_path("my.toml", kThere) == "my.toml");
  CHECK(configuration_path(kAbsent, kThere) == kAbsent);
}

TEST_CASE("without a name it is the standard file") {
  CHECK(configuration_path("", kThere) == kThere);
}

TEST_CASE("a standard file that cannot be looked for is left to the one who reads it") {
  const std::string too_long(5000, 'a');
  CHECK(configuration_path("", too_long) == too_long);
}

TEST_CASE("without any file it is refused, with the file to write and what helps") {
  CHECK_THROWS_AS(configuration_path("", kAbsent), ConfigurationError);
  CHECK_THROWS_WITH(configuration_path("", kAbsent),
                    Catch::StartsWith(kAbsent + ": is absent; must ") &&
                        Catch::Contains("`cremed-doctor --suggest-config`") &&
                        Catch::Contains("--config FILE"));
}

}  // namespace
}  // namespace cremed
