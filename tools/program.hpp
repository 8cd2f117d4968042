// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): the library's.
class App;
class Validator;
}  // namespace CLI

namespace cremed {

/// Adds its options to `app`, parses the command line and does the work; returns the exit status.
using ProgramRun = int (*)(CLI::App& app, int argc, char** argv);

/// main() of a tool: runs it and reports errors. Returns 0, 1 after a failure, or 2 after bad usage
/// or a bad configuration.
int run_program(const char* name, const char* description, ProgramRun run, int argc, char** argv);

/// The check of an option's number. NaN is in no range, but in CLI::Range.
CLI::Validator number_in(double least, double most);

}  // namespace cremed
