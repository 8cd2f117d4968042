// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `cremed-eval drive` alone, for tools/demo: the other commands take longer to build.
#include <CLI/CLI.hpp>

#include "tools/eval/drive/drive_command.hpp"
#include "tools/eval/drive/drive_options.hpp"
#include "tools/program.hpp"

namespace {

int run(CLI::App& app, int argc, char** argv) {
  app.require_subcommand(1);
  cremed::DriveFiles files;
  cremed::add_drive(app, files);
  app.parse(argc, argv);
  cremed::run_drive(files);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program("cremed-eval-drive", "cremed-eval without its other commands", run,
                             argc, argv);
}
