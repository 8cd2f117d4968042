// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/version.hpp"
#include "tools/eval/drive_evaluation.hpp"
#include "tools/eval/pairs_evaluation.hpp"
#include "tools/eval/plot.hpp"
#include "tools/eval/profile.hpp"

namespace {

struct PairsArguments {
  std::string file;
  std::string profile;
  std::string method = "msm";
  std::string output;
  bool doppler = false;
};

struct DriveArguments {
  std::string odometry;
  std::string truth;
  std::string plot;
};

/// Opens a file ("-": standard input) and hands it to `read`; errors name the file.
template <typename Read>
auto with_input(const std::string& path, Read read) {
  std::ifstream file;
  if (path != "-") {
    file.open(path);
    if (!file) {
      throw std::runtime_error("cannot read " + path);
    }
  }
  try {
    return read(path == "-" ? std::cin : static_cast<std::istream&>(file));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

void write_pairs(const std::string& path, const std::vector<cremed::PairResult>& results) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) {
    throw std::runtime_error("cannot write " + path);
  }
  std::fputs("pair,x,y,yaw,cxx,cxy,cxt,cyy,cyt,ctt,iterations,solve_us\n", file);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const cremed::RegistrationResult& r = results[i].registration;
    const Eigen::Matrix3d& c = r.covariance;
    std::fprintf(file, "%zu,%.9f,%.9f,%.9f,%.9e,%.9e,%.9e,%.9e,%.9e,%.9e,%d,%lld\n", i,
                 r.motion.x(), r.motion.y(), r.motion.z(), c(0, 0), c(0, 1), c(0, 2), c(1, 1),
                 c(1, 2), c(2, 2), r.iterations, static_cast<long long>(results[i].solve_us));
  }
  const bool is_lost = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || is_lost) {
    throw std::runtime_error("cannot write " + path);
  }
}

int run_pairs(const PairsArguments& arguments) {
  const auto options = cremed::profile(arguments.profile, arguments.doppler);
  const auto pairs = with_input(arguments.file, cremed::read_registration_pairs);
  if (pairs.empty()) {
    throw std::runtime_error(arguments.file + ": no pairs");
  }
  const auto results = cremed::solve_pairs(pairs, *options);
  std::size_t left_out = 0;
  const auto credibility =
      cremed::evaluate_pairs(pairs, results, options->degrees_of_freedom, left_out);
  double iterations = 0.0;
  double solve_us = 0.0;
  std::size_t unfinished = 0;
  for (const cremed::PairResult& result : results) {
    iterations += result.registration.iterations;
    solve_us += static_cast<double>(result.solve_us);
    unfinished +=
        result.registration.status == cremed::RegistrationStatus::no_convergence ? 1U : 0U;
  }
  const auto count = static_cast<double>(results.size());
  std::printf("# method %s iterations solve_us no_convergence left_out\n",
              cremed::kCredibilityColumns);
  std::printf("%s %s %.2f %.0f %zu %zu\n", arguments.method.c_str(),
              cremed::to_line(credibility).c_str(), iterations / count, solve_us / count,
              unfinished, left_out);
  if (!arguments.output.empty()) {
    write_pairs(arguments.output, results);
  }
  return 0;
}

int run_drive(const DriveArguments& arguments) {
  const auto truth = with_input(arguments.truth,
                                [](std::istream& input) { return cremed::TrueTrajectory(input); });
  const auto sources = with_input(arguments.odometry, [&](std::istream& input) {
    return cremed::evaluate_drive(input, truth);
  });
  if (sources.empty()) {
    throw std::runtime_error(arguments.odometry + ": no odometry");
  }
  std::printf("# source %s\n", cremed::kCredibilityColumns);
  for (const cremed::SourceEvaluation& source : sources) {
    std::printf("%s %s\n", source.source.c_str(), cremed::to_line(source.credibility).c_str());
    if (source.without_estimate + source.outside_truth != 0) {
      std::fprintf(stderr, "%s: %zu rows without estimate, %zu estimates outside of truth's time\n",
                   source.source.c_str(), source.without_estimate, source.outside_truth);
    }
  }
  if (!arguments.plot.empty()) {
    cremed::plot_drive(arguments.odometry, arguments.truth, arguments.plot);
  }
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Figures of cremed's credibility: RMSE, ANEES and coverage", "cremed-eval"};
  app.set_version_flag("--version", "cremed-eval " CREMED_VERSION);
  app.require_subcommand(1);

  PairsArguments pairs;
  CLI::App* pairs_command = app.add_subcommand("pairs", "Register pairs of scans with known truth");
  pairs_command->add_option("FILE", pairs.file, "Pairs as text, - for standard input")->required();
  pairs_command->add_option("--profile", pairs.profile, "Settings: psr, sim or nuscenes")
      ->required()
      ->check(CLI::IsMember({"psr", "sim", "nuscenes"}));
  pairs_command->add_flag("--doppler", pairs.doppler, "Use Doppler");
  pairs_command->add_option("--method", pairs.method, "msm (Max-Sum-Mixture)")
      ->check(CLI::IsMember({"msm"}));
  pairs_command->add_option("--output", pairs.output, "Write each pair's result as CSV");

  DriveArguments drive;
  CLI::App* drive_command =
      app.add_subcommand("drive", "Compare the odometry of a drive with truth");
  drive_command->add_option("ODOMETRY", drive.odometry, "CSV that cremed wrote")->required();
  drive_command->add_option("TRUTH", drive.truth, "CSV: utime,x_m,y_m,yaw_rad")->required();
  drive_command->add_option("--plot", drive.plot, "Draw a picture of the trajectories (PNG, SVG)");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return pairs_command->parsed() ? run_pairs(pairs) : run_drive(drive);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cremed-eval: %s\n", error.what());
    return 1;
  }
}
