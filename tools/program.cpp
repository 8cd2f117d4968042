// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/program.hpp"

#include <cmath>
#include <exception>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "cremed/version.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/process_setup.hpp"
#include "daemon/process/usage_error.hpp"

namespace cremed {
namespace {

constexpr int kFailure = 1;
constexpr int kBadUsage = 2;

int parse_and_run(const char* name, const char* description, ProgramRun run, int argc,
                  char** argv) {
  CLI::App app{description, name};
  app.set_version_flag("--version", std::string(name) + " " CREMED_VERSION);
  try {
    return run(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
}

int report(const char* name, const std::exception& error, int status) {
  std::cerr << name << ": " << error.what() << '\n';
  return status;
}

}  // namespace

int run_program(const char* name, const char* description, ProgramRun run, int argc, char** argv) {
  set_up_process();
  try {
    return finish_process(parse_and_run(name, description, run, argc, argv));
  } catch (const UsageError& error) {
    return report(name, error, kBadUsage);
  } catch (const std::exception& error) {
    return report(name, error, kFailure);
  }
}

CLI::Validator number_in(double least, double most) {
  const CLI::Range range(least, most);
  const auto problem = [range](const std::string& text) {
    double value = 0.0;
    const bool is_nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
    return is_nan ? concat({"Value ", text, " is not a number"}) : range(text);
  };
  return {problem, range.get_description()};
}

}  // namespace cremed
