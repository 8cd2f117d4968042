// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>

#include "tools/eval/input_file.hpp"
#include "tools/laboratory/bench/bench_problem.hpp"
#include "tools/laboratory/bench/bench_report.hpp"
#include "tools/laboratory/bench/component_bench.hpp"
#include "tools/laboratory/bench/pair_bench.hpp"
#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"
#include "tools/program.hpp"

namespace {

using cremed::BenchProblem;

struct Arguments {
  std::string pairs;
  std::string profile = "nuscenes";
  std::string likelihood = "exclusive";
};

void register_all(const Arguments& arguments) {
  const cremed::Likelihood likelihood = cremed::likelihood_named(arguments.likelihood);
  for (BenchProblem& problem : cremed::simulated_problems(likelihood)) {
    cremed::register_pair_bench("pair", std::move(problem));
  }
  if (!arguments.pairs.empty()) {
    const auto pairs = cremed::with_input(arguments.pairs, cremed::read_registration_pairs);
    for (const bool doppler : {false, true}) {
      cremed::register_pair_bench(
          "pair", {doppler ? "file-D" : "file",
                   *cremed::profile(arguments.profile, doppler, likelihood), pairs});
    }
  }
  for (std::size_t targets = 8; targets <= cremed::kMaxDetections; targets *= 2) {
    cremed::register_pair_bench("targets", cremed::problem_of_size(targets, likelihood));
  }
  cremed::register_pair_bench("worst", cremed::ambiguous_problem(likelihood));
  cremed::register_component_bench();
}

int run(CLI::App& app, int argc, char** argv) {
  app.footer(
      "Examples:\n"
      "  Of a simulated pair only.\n"
      "    $ cremed-bench --benchmark_filter=pair/PSR");
  app.allow_extras();
  Arguments arguments;
  app.add_option("--pairs", arguments.pairs, "Recorded pairs to register too (several scans)")
      ->type_name("FILE");
  app.add_option("--profile", arguments.profile, "Their settings: psr, sim or nuscenes")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"psr", "sim", "nuscenes"}));
  app.add_option("--likelihood", arguments.likelihood,
                 "exclusive, or max_sum_mixture (the paper's)")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"exclusive", "max_sum_mixture"}));
  app.parse(argc, argv);
  std::vector<std::string> rest{argv[0]};
  for (std::string& argument : app.remaining()) {
    rest.push_back(std::move(argument));
  }
  std::vector<char*> rest_argv;
  rest_argv.reserve(rest.size());
  for (std::string& argument : rest) {
    rest_argv.push_back(argument.data());
  }
  int rest_argc = static_cast<int>(rest_argv.size());
  benchmark::Initialize(&rest_argc, rest_argv.data());
  if (benchmark::ReportUnrecognizedArguments(rest_argc, rest_argv.data())) {
    return 2;
  }
  register_all(arguments);
  cremed::BenchReport report;
  benchmark::RunSpecifiedBenchmarks(&report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program(
      "cremed-bench",
      "Measures how long a registration takes\n"
      "Further options are Google Benchmark's, such as --benchmark_filter=REGEX and "
      "--benchmark_min_time=SECONDS.",
      run, argc, argv);
}
