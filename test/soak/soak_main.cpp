// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drives through the pipeline for hours with all kinds of faults, and checks each result.

#include <algorithm>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <time.h>

#include "daemon/output/lcm_publisher.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/process_setup.hpp"
#include "test/estimator/allocation_guard.hpp"
#include "test/soak/estimate_checker.hpp"
#include "test/soak/fault_injector.hpp"
#include "test/soak/memory_watch.hpp"
#include "test/soak/soak_drive.hpp"
#include "test/soak/soak_report.hpp"
#include "test/tools/own_network.hpp"

namespace cremed::soak {
namespace {

constexpr double kRequiredShare = 0.999;
constexpr double kPauseS = 2.0;
constexpr double kLeastDriveS = 10.0;
constexpr std::int64_t kProgressUs = 60'000'000;

// Margin for malloc's bins and untouched pages.
constexpr std::size_t kMaxGrowthKib = 64;
constexpr std::size_t kMaxResidentGrowthKib = 4096;

#ifdef CREMED_HAS_SANITIZER_HOOK
constexpr bool kMemoryIsOurs = false;
#else
constexpr bool kMemoryIsOurs = true;
#endif

struct Arguments {
  double seconds = 360.0;
  double speed = 10.0;
  std::uint64_t seed = std::random_device{}();
};

Configuration configuration() {
  Configuration result;
  result.radars = default_radars();
  result.output.publish_scans = true;
  return result;
}

class Soak {
 public:
  explicit Soak(const Arguments& arguments);

  /// Whether all checks passed.
  bool run();

 private:
  void connect();
  void run_drive(std::size_t number, double duration_s);
  void handle(SourceEvent event, const CanFrame& frame);
  void keep_pace();
  void report_progress();
  void report_found();
  bool report_end();
  [[nodiscard]] bool memory_grew() const;

  Arguments arguments_;
  Configuration configuration_ = configuration();
  RadarNames names_{configuration_.radars[0].name, configuration_.radars[1].name, "fused",
                    "odometry"};
  FaultInjector source_{arguments_.seed};
  EstimateChecker checker_{configuration_, source_};
  std::unique_ptr<LcmPublisher> publisher_;
  std::unique_ptr<Pipeline> pipeline_;
  long allocations_ = 0;
  double driven_s_ = 0.0;
  std::int64_t drive_begin_us_ = 0;  // By the drive's clock.
  std::int64_t pace_begin_us_ = 0;   // By our clock.
  std::int64_t begin_us_ = monotonic_us();
  std::int64_t next_progress_us_ = begin_us_ + kProgressUs;
  std::optional<MemoryUse> memory_at_first_;
  MemoryUse memory_;
};

Soak::Soak(const Arguments& arguments) : arguments_(arguments) {
  connect();
  pipeline_ = std::make_unique<Pipeline>(configuration_, source_,
                                         std::vector<OdometrySink*>{publisher_.get(), &checker_},
                                         PipelineClock{&monotonic_us});
}

/// Over the real transport, but never on a shared network.
void Soak::connect() {
  const bool is_alone = test::enter_own_network();
  const std::string url = is_alone ? "udpm://239.255.76.67:7667?ttl=0" : "memq://";
  publisher_ = std::make_unique<LcmPublisher>(url, configuration_);
  if (const std::string problem = publisher_->connect(); !problem.empty()) {
    throw std::runtime_error(problem);
  }
  std::printf("seed %" PRIu64 ", %.0f s of driving, speed %g, LCM over %s\n", arguments_.seed,
              arguments_.seconds, arguments_.speed, url.c_str());
  std::fflush(stdout);
}

bool Soak::run() {
  for (std::size_t number = 0; driven_s_ < arguments_.seconds; ++number) {
    const double whole_s = find_scenario(kScenarios[number % kScenarios.size()])->duration_s;
    const double left_s = std::max(arguments_.seconds - driven_s_, kLeastDriveS);
    run_drive(number, std::min(whole_s, left_s));
    memory_ = memory_use();
    // The first round includes allocations of first use.
    if (number + 1 == kScenarios.size()) {
      memory_at_first_ = memory_;
    }
  }
  return report_end();
}

void Soak::run_drive(std::size_t number, double duration_s) {
  SimulationOptions options;
  options.seed = arguments_.seed + number;
  options.duration_s = duration_s;
  options.start_us +=
      static_cast<std::int64_t>((driven_s_ + kPauseS * static_cast<double>(number)) * 1e6);
  const auto drive =
      std::make_unique<SoakDrive>(number % kScenarios.size(), configuration_.radars, options);
  drive_begin_us_ = options.start_us;
  pace_begin_us_ = monotonic_us();
  source_.begin(drive->simulation);
  checker_.begin(*drive);
  CanFrame frame;
  for (SourceEvent event = source_.next(frame); event != SourceEvent::end;
       event = source_.next(frame)) {
    keep_pace();
    handle(event, frame);
    report_found();
    report_progress();
  }
  driven_s_ += duration_s;
}

void Soak::handle(SourceEvent event, const CanFrame& frame) {
  const AllocationGuard guard;
  pipeline_->on_event(event, frame);
  if (event == SourceEvent::clock_step) {
    checker_.on_clock_step();
  }
  allocations_ += AllocationGuard::stop();
}

void Soak::keep_pace() {
  if (arguments_.speed <= 0.0) {
    return;
  }
  constexpr std::int64_t kShortestSleepUs = 500;
  const auto drive_us = static_cast<double>(source_.now_us() - drive_begin_us_);
  const std::int64_t due_us =
      pace_begin_us_ + static_cast<std::int64_t>(drive_us / arguments_.speed);
  if (due_us - monotonic_us() > kShortestSleepUs) {
    const timespec due{due_us / 1'000'000, due_us % 1'000'000 * 1000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
  }
}

void Soak::report_found() {
  for (const Found& found : checker_.take_found()) {
    print(found, names_);
  }
  for (const Comparison& comparison : checker_.take_beyond()) {
    print(comparison, names_);
  }
}

void Soak::report_progress() {
  const std::int64_t now_us = monotonic_us();
  if (now_us < next_progress_us_) {
    return;
  }
  next_progress_us_ += kProgressUs;
  const Tally all = total(checker_);
  const MemoryUse use = memory_use();
  std::printf("%3.0f min: %.0f s driven, %" PRIu64 " estimates, %.4f %% within %.0f sigma, %" PRIu64
              " violations, %ld allocations, %zu KiB resident\n",
              static_cast<double>(now_us - begin_us_) / 6e7,
              driven_s_ + static_cast<double>(source_.now_us() - drive_begin_us_) * 1e-6,
              all.estimates, 100.0 * share_within(all), kMaxSigmas, checker_.violations(),
              allocations_, use.resident_kib);
  std::fflush(stdout);
}

bool Soak::memory_grew() const {
  return kMemoryIsOurs && memory_at_first_ &&
         (memory_.allocated_kib > memory_at_first_->allocated_kib + kMaxGrowthKib ||
          memory_.resident_kib > memory_at_first_->resident_kib + kMaxResidentGrowthKib);
}

bool Soak::report_end() {
  const Tally all = total(checker_);
  const bool is_credible = share_within(all) >= kRequiredShare;
  print_tallies(checker_, names_);
  print_faults(source_);
  const double wall_s = static_cast<double>(monotonic_us() - begin_us_) * 1e-6;
  std::printf("%.0f s driven in %.0f s: %.1f times real time\n", driven_s_, wall_s,
              driven_s_ / wall_s);
  if (memory_at_first_) {
    std::printf(
        "memory after the first round and at the end: allocated %zu and %zu KiB, resident "
        "%zu and %zu KiB: %s\n",
        memory_at_first_->allocated_kib, memory_.allocated_kib, memory_at_first_->resident_kib,
        memory_.resident_kib, memory_grew() ? "GREW" : "did not grow");
  }
  for (std::size_t i = 0; i < kViolationNames.size(); ++i) {
    std::printf("%8" PRIu64 " %s\n", checker_.counts()[i], std::string(kViolationNames[i]).c_str());
  }
  std::printf("%8ld allocations between a frame and its message\n", allocations_);
  std::printf("%8" PRIu64 " messages that could not be published\n", publisher_->failures());
  const bool good = checker_.violations() == 0 && allocations_ == 0 &&
                    publisher_->failures() == 0 && !memory_grew() && is_credible;
  std::printf("%.4f %% of %" PRIu64 " estimates within %.0f sigma of truth (required %.1f): %s\n",
              100.0 * share_within(all), all.estimates, kMaxSigmas, 100.0 * kRequiredShare,
              good ? "all good" : "NOT GOOD");
  return good;
}

}  // namespace
}  // namespace cremed::soak

int main(int argc, char** argv) {
  cremed::set_up_process();
  CLI::App app{"Simulated drives with random faults through the pipeline; checks every result"};
  cremed::soak::Arguments arguments;
  app.add_option("--seconds", arguments.seconds, "Driving, in seconds of the vehicle's time")
      ->check(CLI::Range(1.0, 1e7))
      ->capture_default_str();
  app.add_option("--speed", arguments.speed, "Times real time; 0: as fast as possible")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "The same seed makes the same run; default: random");
  CLI11_PARSE(app, argc, argv);
  try {
    return cremed::soak::Soak(arguments).run() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cremed-soak: %s\n", error.what());
    return 1;
  }
}
