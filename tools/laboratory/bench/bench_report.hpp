// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <benchmark/benchmark.h>

namespace cremed {

/// Prints Google Benchmark's table as it grows, and at the end one table per group of benchmarks,
/// with the counters in columns.
class BenchReport : public benchmark::ConsoleReporter {
 public:
  BenchReport() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::vector<Run> runs_;
};

}  // namespace cremed
