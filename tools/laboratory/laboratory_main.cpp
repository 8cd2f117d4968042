// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/process/file_aliases.hpp"
#include "tools/eval/drive/drive_options.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/plot.hpp"
#include "tools/eval/report_file.hpp"
#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/figures_json.hpp"
#include "tools/laboratory/pairs/correspondence_counts.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"
#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/pairs/registration_method.hpp"
#include "tools/laboratory/table/table_command.hpp"
#include "tools/program.hpp"

namespace {

struct TableArguments {
  cremed::PaperTableOptions options{.threads = std::max(std::thread::hardware_concurrency(), 1U)};
  std::string real;
  std::string drives;
  bool write = false;
  cremed::TruthNoise truth_noise;
  std::string plot;
  bool as_json = false;
};

struct PairsArguments {
  std::string file;
  std::string profile;
  std::string method = "msm";
  std::string likelihood = "exclusive";
  std::string output;
  std::string plot;
  bool doppler = false;
  bool as_json = false;
};

void write_pairs(const std::string& path, const std::vector<cremed::PairResult>& results) {
  cremed::ReportFile file(path);
  file.print("pair,x,y,yaw,cxx,cxy,cxt,cyy,cyt,ctt,iterations,solve_us\n");
  for (std::size_t i = 0; i < results.size(); ++i) {
    const cremed::RegistrationResult& r = results[i].registration;
    const Eigen::Matrix3d& c = r.covariance;
    file.print("{},{:.9f},{:.9f},{:.9f},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{},{}\n", i,
               r.motion.x(), r.motion.y(), r.motion.z(), c(0, 0), c(0, 1), c(0, 2), c(1, 1),
               c(1, 2), c(2, 2), r.iterations, results[i].solve_us);
  }
  file.close();
}

void plot_pairs(const std::vector<cremed::RegistrationPair>& pairs, const std::string& picture) {
  const cremed::TemporaryFolder folder;
  const std::string counts = folder.file("correspondences.csv");
  cremed::write_correspondences_csv(counts, pairs);
  cremed::draw_plot("plot_pairs", {counts}, picture);
}

void print_pairs(const PairsArguments& arguments, const cremed::PairsFigures& figures) {
  if (arguments.as_json) {
    fmt::print("{}\n", cremed::pairs_json(arguments.method, figures));
    return;
  }
  fmt::print("# method {} iterations solve_us no_convergence left_out\n",
             cremed::kCredibilityColumns);
  fmt::print("{:<8} {} {:>10.2f} {:>8.0f} {:14} {:8}\n", arguments.method,
             cremed::to_line(figures.credibility), figures.iterations, figures.solve_us,
             figures.no_convergence, figures.left_out);
}

int run_pairs(const PairsArguments& arguments) {
  const cremed::RegistrationMethod method = cremed::registration_method(arguments.method);
  const auto options = cremed::profile(arguments.profile, arguments.doppler,
                                       cremed::likelihood_named(arguments.likelihood));
  const auto pairs = cremed::with_input(arguments.file, cremed::read_registration_pairs);
  if (pairs.empty()) {
    throw std::runtime_error(arguments.file + ": no pairs");
  }
  const auto results = cremed::solve_pairs(pairs, *options, method.solve);
  print_pairs(arguments, cremed::pairs_figures(
                             results, method.is_always_3dof ? 3 : options->degrees_of_freedom));
  if (!arguments.output.empty()) {
    write_pairs(arguments.output, results);
  }
  if (!arguments.plot.empty()) {
    plot_pairs(pairs, arguments.plot);
  }
  return 0;
}

CLI::App* add_table(CLI::App& app, TableArguments& arguments) {
  cremed::PaperTableOptions& options = arguments.options;
  CLI::App* command = app.add_subcommand("table", "The paper's problems: its figures and ours");
  command->footer(
      "Examples:\n"
      "  All problems, fewer times than in the paper.\n"
      "    $ cremed-eval table --sets 10 --runs 100 --plot table.png");
  CLI::Option* real = command->add_option(
      "--real", arguments.real,
      "Folder with drives from cremed-convert nuscenes: the paper's real problems in place of the "
      "simulated ones, with a simulated mobile robot");
  real->type_name("FOLDER");
  cremed::add_truth_std(*command, arguments.truth_noise)->needs(real);
  CLI::Option* drives =
      command->add_option("--drives", arguments.drives,
                          "Folder with the project's recorded drives: the tables of them in "
                          "tools/eval/README.md, from the odometry "
                          "with the configurations in config/; run in the project's folder");
  drives->type_name("FOLDER")->excludes(real);
  command->add_flag("--write", arguments.write, "Write these tables there")->needs(drives);
  command->add_option("--sets", options.sets, "Sets of landmarks (as the paper: 100, Sim 50)")
      ->excludes(drives)
      ->excludes(real)
      ->check(CLI::Range(1, 1000000));
  command->add_option("--runs", options.runs, "Runs with each set (as the paper: 1000, Sim 500)")
      ->excludes(drives)
      ->excludes(real)
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", options.seed, "Seed of all random numbers")->capture_default_str();
  command->add_option("--threads", options.threads, "Number of threads; no effect on the figures")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--plot", arguments.plot, "Draw figures, NEES and costs (PNG, SVG)")
      ->type_name("FILE")
      ->check(cremed::picture_problem)
      ->excludes(drives)
      ->excludes(real);
  command->add_flag("--json", arguments.as_json, "Print the figures as JSON")->excludes(drives);
  return command;
}

CLI::App* add_pairs(CLI::App& app, PairsArguments& arguments) {
  CLI::App* command = app.add_subcommand("pairs", "Register pairs of scans with known truth");
  command->footer(
      "Examples:\n"
      "  With the paper's likelihood.\n"
      "    $ cremed-eval pairs pairs.txt --profile psr --doppler --likelihood max_sum_mixture");
  command->add_option("FILE", arguments.file, "Pairs as text, - for standard input")
      ->type_name("")
      ->required();
  command->add_option("--profile", arguments.profile, "Settings: psr, sim, nuscenes or robot")
      ->type_name("NAME")
      ->required()
      ->check(CLI::IsMember({"psr", "sim", "nuscenes", "robot"}));
  command->add_flag("--doppler", arguments.doppler, "Use Doppler");
  command
      ->add_option("--method", arguments.method,
                   "msm (Max-Sum-Mixture), sa (summing approximation) or icp (without Doppler)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"msm", "sa", "icp"}));
  command
      ->add_option("--likelihood", arguments.likelihood,
                   "Of msm: exclusive (one partner per target) or max_sum_mixture (the paper's)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"exclusive", "max_sum_mixture"}))
      ->capture_default_str();
  command->add_option("--output", arguments.output, "Write each pair's result as CSV")
      ->type_name("FILE");
  command
      ->add_option("--plot", arguments.plot,
                   "Draw the number of targets with a partner by the true motion (PNG, SVG)")
      ->type_name("FILE")
      ->check(cremed::picture_problem);
  command->add_flag("--json", arguments.as_json, "Print the figures as JSON");
  return command;
}

int run(CLI::App& app, int argc, char** argv) {
  app.set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
  app.require_subcommand(1);
  TableArguments table;
  PairsArguments pairs;
  const CLI::App* table_command = add_table(app, table);
  add_pairs(app, pairs);
  app.parse(argc, argv);
  cremed::refuse_aliases(
      {{"FILE", pairs.file}},
      {{"--output", pairs.output}, {"--plot", pairs.plot}, {"--plot", table.plot}});
  if (!table_command->parsed()) {
    return run_pairs(pairs);
  }
  if (!table.real.empty()) {
    cremed::run_real_table(
        {table.real, table.options.seed, table.options.threads, table.truth_noise}, table.as_json);
  } else if (!table.drives.empty()) {
    cremed::run_drive_table({.data = table.drives, .threads = table.options.threads}, table.write);
  } else {
    cremed::run_table(table.options, table.plot, table.as_json);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program("cremed-laboratory",
                             "What reproduces the paper's figures: cremed-eval table and pairs",
                             run, argc, argv);
}
