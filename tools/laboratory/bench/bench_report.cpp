// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/bench_report.hpp"

#include <array>
#include <cstdio>
#include <span>

namespace cremed {
namespace {

struct Column {
  const char* counter;
  const char* title;
  int digits;
};

/// Benchmarks whose names have a common prefix.
struct Group {
  const char* prefix;
  const char* title;
  std::span<const Column> columns;
};

constexpr std::array<Column, 7> kPairColumns{{{"p50_us", "p50 us", 1},
                                              {"p99_us", "p99 us", 1},
                                              {"max_us", "max us", 1},
                                              {"least_us", "least us", 1},
                                              {"evaluations", "evaluations", 0},
                                              {"floor_us", "floor us", 1},
                                              {"ratio", "least/floor", 2}}};
constexpr std::array<Column, 5> kTargetColumns{{{"p50_us", "p50 us", 1},
                                                {"max_us", "max us", 1},
                                                {"evaluations", "evaluations", 0},
                                                {"ns_per_target2", "ns/target^2", 1},
                                                {"ratio", "least/floor", 2}}};
constexpr std::array<Column, 3> kComponentColumns{
    {{"ns", "ns", 2}, {"floor_ns", "floor ns", 2}, {"ratio", "ns/floor", 2}}};

constexpr std::array<Group, 4> kGroups{
    {{"pair/", "Time per pair; floor: as many bare evaluations of a mixture component",
      kPairColumns},
     {"worst/", "256 against 256 targets, 3 DoF, Doppler, all within their noise of each other",
      kPairColumns},
     {"targets/", "Growth with the number of targets in each scan", kTargetColumns},
     {"components/", "Time of one evaluation of a mixture component, by number of targets",
      kComponentColumns}}};

void print_header(const Group& group) {
  std::printf("\n%s\n%-20s", group.title, "");
  for (const Column& column : group.columns) {
    std::printf(" %12s", column.title);
  }
  std::printf("\n");
}

void print_row(const Group& group, const std::string& name,
               const benchmark::UserCounters& counters) {
  std::printf("%-20s", name.c_str());
  for (const Column& column : group.columns) {
    const auto counter = counters.find(column.counter);
    const double value = counter == counters.end() ? 0.0 : counter->second.value;
    std::printf(" %12.*f", column.digits, value);
  }
  std::printf("\n");
}

/// "pair/Sim-D/manual_time" -> "Sim-D".
std::string short_name(const std::string& name, const std::string& prefix) {
  const std::string rest = name.substr(prefix.size());
  return rest.substr(0, rest.find('/'));
}

}  // namespace

void BenchReport::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.run_type == Run::RT_Iteration && !run.error_occurred) {
      runs_.push_back(run);
    }
  }
}

void BenchReport::Finalize() {
  ConsoleReporter::Finalize();
  GetOutputStream().flush();
  for (const Group& group : kGroups) {
    bool has_header = false;
    for (const Run& run : runs_) {
      const std::string name = run.benchmark_name();
      if (name.rfind(group.prefix, 0) != 0) {
        continue;
      }
      if (!has_header) {
        print_header(group);
        has_header = true;
      }
      print_row(group, short_name(name, group.prefix), run.counters);
    }
  }
}

}  // namespace cremed
