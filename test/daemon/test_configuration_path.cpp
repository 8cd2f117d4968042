// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_path.hpp"
#include "daemon/configuration/first_configuration.hpp"

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
                        Catch::Contains(std::string(kWriteFirst)) &&
                        Catch::Contains("--config FILE"));
}

TEST_CASE("a standard file is unwritten if it is absent or as the package installs it") {
  CHECK(is_unwritten(kAbsent));
  CHECK(is_unwritten(CREMED_SOURCE_DIR "/tools/package/cremed.toml"));
  CHECK_FALSE(is_unwritten(kThere));
  CHECK_FALSE(is_unwritten(std::string(5000, 'a')));  // Unknown: the one who reads it says why.
}

}  // namespace
}  // namespace cremed
