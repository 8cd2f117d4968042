// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>

#include "cremed/estimator/cost/mixture_kernel.hpp"
#include "daemon/process/process_setup.hpp"
#include "daemon/version.hpp"
#include "tools/bench/bench_problem.hpp"
#include "tools/bench/bench_report.hpp"
#include "tools/bench/component_bench.hpp"
#include "tools/bench/pair_bench.hpp"
#include "tools/eval/pairs/profile.hpp"
#include "tools/eval/pairs/registration_pairs.hpp"

namespace {

using cremed::BenchProblem;
using cremed::Likelihood;

struct Arguments {
  std::string pairs;
  std::string profile = "nuscenes";
  std::string covariance = "exclusive";
};

std::vector<cremed::RegistrationPair> read_pairs(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error("cannot read " + path);
  }
  try {
    return cremed::read_registration_pairs(file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

void register_all(const Arguments& arguments) {
  const auto covariance =
      arguments.covariance == "exclusive" ? Likelihood::exclusive : Likelihood::max_sum_mixture;
  for (BenchProblem& problem : cremed::simulated_problems(covariance)) {
    cremed::register_pair_bench("pair", std::move(problem));
  }
  if (!arguments.pairs.empty()) {
    const auto pairs = read_pairs(arguments.pairs);
    for (const bool doppler : {false, true}) {
      cremed::register_pair_bench(
          "pair", {doppler ? "file-D" : "file",
                   *cremed::profile(arguments.profile, doppler, covariance), pairs});
    }
  }
  for (std::size_t targets = 8; targets <= cremed::kMaxDetections; targets *= 2) {
    cremed::register_pair_bench("targets", cremed::problem_of_size(targets, covariance));
  }
  cremed::register_pair_bench("worst", cremed::ambiguous_problem(covariance));
  cremed::register_component_bench();
}

int run(int argc, char** argv) {
  CLI::App app{
      "Measures how long a registration takes\n"
      "Further options are Google Benchmark's, such as --benchmark_filter=REGEX and "
      "--benchmark_min_time=SECONDS.",
      "cremed-bench"};
  app.set_version_flag("--version", "cremed-bench " CREMED_VERSION);
  app.allow_extras();
  Arguments arguments;
  app.add_option("--pairs", arguments.pairs, "Recorded pairs to register as well (several scans)");
  app.add_option("--profile", arguments.profile, "Their settings: psr, sim or nuscenes")
      ->capture_default_str()
      ->check(CLI::IsMember({"psr", "sim", "nuscenes"}));
  app.add_option("--covariance", arguments.covariance, "exclusive, or gauss_newton as the paper")
      ->capture_default_str()
      ->check(CLI::IsMember({"exclusive", "gauss_newton"}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
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
  std::printf("Kernel: %s, one thread\n", cremed::mixture_kernels().front().name.data());
  cremed::BenchReport report;
  benchmark::RunSpecifiedBenchmarks(&report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  cremed::set_up_process();
  try {
    return cremed::finish_process(run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cremed-bench: %s\n", error.what());
    return 1;
  }
}
