// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "test/data_tests/real_fault_drives.hpp"
#include "test/faults/drive_figures.hpp"
#include "test/faults/figures_line.hpp"
#include "test/faults/parked_drive.hpp"
#include "test/faults/random_faults.hpp"
#include "test/faults/reversed_drive.hpp"
#include "test/faults/start_drive.hpp"
#include "test/faults/systematic_faults.hpp"
#include "test/faults/unusual_faults.hpp"
#include "tools/program.hpp"

namespace {

using namespace cremed;
using namespace cremed::test;

struct Options {
  double seconds = 40.0;
  double from_s = 0.0;
  double nuscenes_from_s = 0.0;
  bool are_rows_printed = false;
  bool is_healthy = false;
  bool is_reversed = false;
  bool are_unusual = false;
  std::size_t random_faults = 0;
  std::string radars;
  std::string car = "nuscenes-singapore";
  std::uint64_t seeds = 20;
  std::optional<std::uint64_t> only_seed;
  std::string filter;
  std::vector<std::string> drives;

  [[nodiscard]] std::uint64_t seed() const { return only_seed.value_or(1); }
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("DRIVE", options.drives,
                 "A scene of nuScenes (0061), 105 or 105-unflagged (RadarScenes), a scenario of "
                 "cremed-simulate (bends), what departs beside a parked vehicle (train, convoy, "
                 "jam-starts), or a start of the vehicle itself: own-start")
      ->required();
  app.add_option("--seconds", options.seconds, "Only so much of 105 and of simulated drives")
      ->capture_default_str();
  app.add_option("--from", options.from_s, "105 from then on");
  app.add_option("--nuscenes-from", options.nuscenes_from_s, "Scenes of nuScenes from then on");
  app.add_flag("--rows", options.are_rows_printed, "Print each row of the odometry");
  app.add_option("--case", options.filter, "Only cases whose name and radar contain it");
  app.add_option("--random", options.random_faults,
                 "So many faults of random kind, size, radar and time (--seed) instead");
  app.add_flag("--unusual", options.are_unusual,
               "Those that come slowly, or that no value of the configuration describes, instead");
  app.add_flag("--reversed", options.is_reversed, "Recorded drives backwards (ReversedDrive)");
  app.add_flag("--healthy", options.is_healthy, "No fault");
  app.add_option("--car", options.car, "Of simulated drives: config/NAME.toml")
      ->capture_default_str();
  app.add_option("--radars", options.radars,
                 "Recorded drives with these radars only, A,B (not with the faults of a list, "
                 "which name all)");
  auto* seeds = app.add_option("--seeds", options.seeds, "So many parked vehicles or own starts")
                    ->capture_default_str();
  app.add_option("--seed", options.only_seed, "Only this one; of simulated drives")
      ->excludes(seeds);
}

FaultDrive recorded_drive_of(const std::string& name, const Options& options) {
  if (name.starts_with("105")) {
    return part_of(radarscenes_fault_drive(name == "105"), options.seconds, options.from_s);
  }
  return part_of(nuscenes_fault_drive(name), 1e9, options.nuscenes_from_s);
}

FaultDrive drive_of(const std::string& name, const Options& options) {
  if (find_scenario(name) != nullptr) {
    return simulated_fault_drive(name, options.seconds, configuration_of_car(options.car).radars,
                                 options.seed());
  }
  const FaultDrive drive = with_radars(recorded_drive_of(name, options), options.radars);
  return options.is_reversed ? ReversedDrive::of(drive) : drive;
}

using Job = std::function<std::string()>;

/// Two at a time; each gives a line, printed in order.
void run_all(const std::vector<Job>& jobs) {
  std::vector<std::string> lines(jobs.size());
  std::size_t printed = 0;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      std::string line = jobs[i]();
      const std::lock_guard lock(mutex);
      lines[i] = std::move(line);
      for (; printed < lines.size() && !lines[printed].empty(); ++printed) {
        std::printf("%s\n", lines[printed].c_str());
      }
      std::fflush(stdout);
    }
  };
  std::thread other(work);
  work();
  other.join();
  const auto held = std::count_if(lines.begin(), lines.end(),
                                  [](const std::string& line) { return line.starts_with(' '); });
  std::printf("all holds in %td of %zu\n", held, lines.size());
}

/// `drive_of(seed)`
void run_seeds(const std::function<FaultDrive(std::uint64_t)>& drive_of, const Options& options) {
  std::vector<Job> jobs;
  const std::uint64_t last = options.only_seed.value_or(options.seeds);
  for (std::uint64_t seed = options.seed(); seed <= last; ++seed) {
    jobs.emplace_back([&drive_of, seed] {
      const FaultDrive drive = drive_of(seed);
      const auto stands_us = static_cast<std::int64_t>(1e6 * ParkedDrive::kDepartureS);
      const FaultCase none{"none", "", {drive.start_us() + stands_us, kNever}};
      return figures_line(drive, none, judged(drive, none));
    });
  }
  run_all(jobs);
}

void print_rows(const FaultDrive& drive, const FaultCase& fault) {
  const FaultRecord result = record(drive, fault);
  std::printf("%s %s\n", fault.kind.c_str(), fault.of.c_str());
  DriveJudge(drive, fault, result).print_rows();
}

std::vector<FaultCase> faults_of(const FaultDrive& drive, const Options& options) {
  if (options.are_unusual) {
    return UnusualFaults(drive).all();
  }
  return options.random_faults == 0
             ? SystematicFaults(drive).all()
             : RandomFaults(drive, options.seed()).draw(options.random_faults);
}

void run_faults(const FaultDrive& drive, const Options& options) {
  std::vector<Job> jobs;
  for (const FaultCase& fault : faults_of(drive, options)) {
    if ((fault.kind + " " + fault.of).find(options.filter) == std::string::npos) continue;
    if (options.are_rows_printed) {
      print_rows(drive, fault);
    } else {
      jobs.emplace_back(
          [&drive, fault] { return figures_line(drive, fault, judged(drive, fault)); });
    }
  }
  run_all(jobs);
}

void run_healthy(const FaultDrive& drive, const Options& options) {
  const FaultCase none{"none", options.radars, {drive.start_us(), kNever}};
  if (options.are_rows_printed) {
    print_rows(drive, none);
  } else {
    std::printf("%s\n", figures_line(drive, none, judged(drive, none)).c_str());
  }
}

void run_drive(const std::string& name, const Options& options) {
  const auto* const parked =
      std::ranges::find(kNeighbours, name, [](const auto& each) { return each.first; });
  if (parked != kNeighbours.end()) {
    run_seeds([&](auto seed) { return ParkedDrive(parked->second, seed).drive(); }, options);
  } else if (name == "own-start") {
    run_seeds([](auto seed) { return StartDrive(seed).drive(); }, options);
  } else if (options.is_healthy) {
    run_healthy(drive_of(name, options), options);
  } else {
    run_faults(drive_of(name, options), options);
  }
}

int run(CLI::App& app, int argc, char** argv) {
  Options options;
  add_options(app, options);
  app.parse(argc, argv);
  ::setenv("CREMED_SHARED", CREMED_SOURCE_DIR "/../shared", 0);
  std::printf("%s%s\n", kColumns, figures_header().c_str());
  for (const std::string& name : options.drives) {
    run_drive(name, options);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("fault_bench",
                     "What systematic faults do to recorded and simulated drives, a line for each; "
                     "CREMED_SHARED names the folder with the recorded data",
                     run, argc, argv);
}
