// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/listening.hpp"

#include <cstdlib>

#include <CLI/CLI.hpp>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/lcm_url.hpp"

namespace cremed {
namespace {

bool can_be_heard(const std::string& url) {
  if (url.starts_with("file://")) {
    return url.find("mode=w") == std::string::npos;
  }
  return url != "none" && is_lcm_url(url);
}

}  // namespace

void add_lcm_url(CLI::App& app, std::string& url) {
  const char* const named = std::getenv("LCM_DEFAULT_URL");
  url = named != nullptr ? named : OutputConfiguration{}.lcm_url;
  app.add_option("--lcm-url", url,
                 "Where to listen (default: $LCM_DEFAULT_URL, or LCM's default group); "
                 "file://LOG plays a log of lcm-logger")
      ->type_name("URL");
}

void require_audible(const std::string& url) {
  if (!can_be_heard(url)) {
    throw CLI::ValidationError("--lcm-url",
                               "'" + url + "' is no URL such as " + OutputConfiguration{}.lcm_url);
  }
}

}  // namespace cremed
