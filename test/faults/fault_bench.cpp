// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What systematic faults do to recorded and simulated drives, a line for each: see kUsage.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "test/data_tests/real_fault_drives.hpp"
#include "test/faults/drive_figures.hpp"
#include "test/faults/figures_line.hpp"
#include "test/faults/parked_drive.hpp"
#include "test/faults/random_faults.hpp"
#include "test/faults/reversed_drive.hpp"
#include "test/faults/start_drive.hpp"
#include "test/faults/systematic_faults.hpp"

namespace {

using namespace cremed;
using namespace cremed::test;

constexpr const char* kUsage =
    R"(fault_bench [--seconds S] [--case TEXT] DRIVE...

Drives: a scene of nuScenes (0061), 105 or 105-unflagged (RadarScenes), a scenario of
cremed-simulate (bends), what departs beside a parked vehicle: train, convoy, jam-starts, or a start
of the vehicle itself: own-start.
CREMED_SHARED names the folder with the recorded data.
  --seconds S  only so much of 105 and of simulated drives (default 40)
  --from S     105 from then on,
  --nuscenes-from S  and the scenes of nuScenes
  --rows       each row of the odometry
  --case TEXT  only cases whose name and radar contain it
  --random N   so many faults of random kind, size, radar and time (--seed) instead
  --reversed   recorded drives backwards (ReversedDrive)
  --healthy    no fault
  --car NAME   of simulated drives: config/NAME.toml (default nuscenes-singapore)
  --radars A,B recorded drives with these radars only (not with the faults of a list, which name all)
  --seeds N    so many of the latter two (default 20)
  --seed N     only this one; of simulated drives

)";

struct Options {
  double seconds = 40.0;
  double from_s = 0.0;
  double nuscenes_from_s = 0.0;
  bool are_rows_printed = false;
  bool is_healthy = false;
  bool is_reversed = false;
  std::size_t random_faults = 0;
  std::string radars;
  std::string car = "nuscenes-singapore";
  std::uint64_t seed = 1;
  std::uint64_t seeds = 20;
  std::string filter;
  std::vector<std::string> drives;
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--seconds" && i + 1 < argc) {
      options.seconds = std::atof(argv[++i]);
    } else if (argument == "--seeds" && i + 1 < argc) {
      options.seeds = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--seed" && i + 1 < argc) {
      options.seed = options.seeds = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--from" && i + 1 < argc) {
      options.from_s = std::atof(argv[++i]);
    } else if (argument == "--random" && i + 1 < argc) {
      options.random_faults = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--nuscenes-from" && i + 1 < argc) {
      options.nuscenes_from_s = std::atof(argv[++i]);
    } else if (argument == "--reversed") {
      options.is_reversed = true;
    } else if (argument == "--healthy") {
      options.is_healthy = true;
    } else if (argument == "--radars" && i + 1 < argc) {
      options.radars = argv[++i];
    } else if (argument == "--car" && i + 1 < argc) {
      options.car = argv[++i];
    } else if (argument == "--rows") {
      options.are_rows_printed = true;
    } else if (argument == "--case" && i + 1 < argc) {
      options.filter = argv[++i];
    } else if (argument.starts_with("-")) {
      throw std::runtime_error(kUsage);
    } else {
      options.drives.emplace_back(argument);
    }
  }
  if (options.drives.empty()) throw std::runtime_error(kUsage);
  return options;
}

FaultDrive recorded_drive_of(const std::string& name, const Options& options) {
  if (name.starts_with("105")) {
    return radarscenes_fault_drive(name == "105", options.seconds, options.from_s);
  }
  return nuscenes_fault_drive(name, 1e9, options.nuscenes_from_s);
}

FaultDrive drive_of(const std::string& name, const Options& options) {
  if (find_scenario(name) != nullptr) {
    return simulated_fault_drive(name, options.seconds, configuration_of_car(options.car).radars,
                                 options.seed);
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
void run_seeds(const std::function<FaultDrive(std::uint64_t)>& drive_of, std::uint64_t first,
               std::uint64_t last) {
  std::vector<Job> jobs;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
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
  return options.random_faults == 0 ? SystematicFaults(drive).all()
                                    : RandomFaults(drive, options.seed).draw(options.random_faults);
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

}  // namespace

int main(int argc, char** argv) {
  try {
    if (std::getenv("CREMED_SHARED") == nullptr) {
      ::setenv("CREMED_SHARED", CREMED_SOURCE_DIR "/../shared", 1);
    }
    const Options options = options_of(argc, argv);
    std::printf("%s%s\n", kColumns, figures_header().c_str());
    for (const std::string& name : options.drives) {
      const auto parked = std::find_if(kNeighbours.begin(), kNeighbours.end(),
                                       [&](const auto& each) { return each.first == name; });
      if (parked != kNeighbours.end()) {
        run_seeds([&](auto seed) { return ParkedDrive(parked->second, seed).drive(); },
                  options.seed, options.seeds);
      } else if (name == "own-start") {
        run_seeds([](auto seed) { return StartDrive(seed).drive(); }, options.seed, options.seeds);
      } else if (options.is_healthy) {
        const FaultDrive drive = drive_of(name, options);
        const FaultCase none{"none", options.radars, {drive.start_us(), kNever}};
        if (options.are_rows_printed) {
          print_rows(drive, none);
        } else {
          std::printf("%s\n", figures_line(drive, none, judged(drive, none)).c_str());
        }
      } else {
        run_faults(drive_of(name, options), options);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
