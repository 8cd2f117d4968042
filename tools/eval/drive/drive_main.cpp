// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `cremed-eval drive` alone, for tools/demo: the other commands take longer to build.
#include <cstdio>
#include <exception>

#include "daemon/process/plain_streams.hpp"
#include "daemon/process/process_setup.hpp"
#include "tools/eval/drive/drive_command.hpp"
#include "tools/eval/drive/drive_options.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"cremed-eval without its other commands", "cremed-eval-drive"};
  app.require_subcommand(1);
  cremed::DriveFiles files;
  cremed::add_drive(app, files);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  cremed::run_drive(files);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  cremed::set_up_process();
  cremed::make_standard_streams_plain();
  try {
    return cremed::finish_process(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cremed-eval-drive: %s\n", error.what());
    return 1;
  }
}
