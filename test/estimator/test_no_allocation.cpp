// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "cremed/estimator/fusion/state/gaussian_state.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/allocation_guard.hpp"
#include "test/estimator/drawn_vehicle.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/odometry_drive.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::Random;

constexpr double kDt = 0.1;

/// Prevents the compiler from removing an allocation.
void* volatile escaped = nullptr;
void use(void* block) { escaped = block; }

template <typename Action>
long count_allocations(const Action& action) {
  const AllocationGuard guard;
  action();
  return AllocationGuard::stop();
}

TEST_CASE("the guard counts every kind of allocation") {
  struct Row {
    std::string what;
    void (*allocate)();
  };
  const std::vector<Row> rows = {
      {"malloc",
       [] {
         void* block = std::malloc(3);
         use(block);
         std::free(block);
       }},
      {"calloc",
       [] {
         void* block = std::calloc(3, 5);
         use(block);
         std::free(block);
       }},
      {"new",
       [] {
         const auto number = std::make_unique<int>(1);
         use(number.get());
       }},
      {"new[]",
       [] {
         const auto numbers = std::make_unique<double[]>(9);
         use(numbers.get());
       }},
      {"aligned new",
       [] {
         struct alignas(64) Line {
           char bytes[64];
         };
         const auto line = std::make_unique<Line>();
         use(line.get());
       }},
      {"std::vector",
       [] {
         std::vector<int> numbers(5);
         use(numbers.data());
       }},
      {"std::function",
       [] {
         const std::array<double, 9> big{};
         const std::function<double()> function = [big] { return big[3]; };
         function();
       }},
      {"Eigen",
       [] {
         Eigen::VectorXd vector(7);
         use(vector.data());
       }},
  };
  const std::vector<Row> rare = {
      {"aligned_alloc",
       [] {
         void* block = std::aligned_alloc(64, 128);
         use(block);
         std::free(block);
       }},
      {"posix_memalign",
       [] {
         void* block = nullptr;
         const int error = posix_memalign(&block, 64, 128);
         use(error == 0 ? block : nullptr);
         std::free(block);
       }},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    CHECK(count_allocations(row.allocate) == 1);
  }
  for (const Row& row : rare) {
    CAPTURE(row.what);
    CHECK(count_allocations(row.allocate) == (kGuardSeesAll ? 1 : 0));
  }
  void* block = std::malloc(1);
  use(block);
  // Clang knows what realloc does, and moves the call to where its result is used.
  void* (*volatile reallocate)(void*, std::size_t) = std::realloc;
  CHECK(count_allocations([&] { block = reallocate(block, 5000); }) == (kGuardSeesAll ? 1 : 0));
  std::free(block);
  CHECK(count_allocations([] {}) == 0);
}

struct Scans {
  RadarScan first;
  RadarScan second;
};

/// A full scan: as many detections as the capacity, some of them moving targets and clutter.
Scans full_scans() {
  Random random(1);
  const simulation::Points points =
      simulation::scatter(random, kMaxDetections, 2.0, 60.0, radians(60.0), 0.0);
  Detections first = simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, {});
  Detections second = simulation::observe_all(points, {1.0, 0.0, radians(1.0)}, kDt, {}, {});
  simulation::perturb(first, random);
  simulation::perturb(second, random);
  for (std::size_t i = 0; i < kMaxDetections; i += 5) {
    second[i].doppler_mps += i % 2 == 0 ? 12.0 : -12.0;
    first[i].range_m += 7.0;
  }
  return {simulation::scan(first, 1000000), simulation::scan(second, 1100000)};
}

TEST_CASE("registration does not allocate") {
  const Scans scans = full_scans();
  SelectionCounters counters;
  const auto targets = std::make_unique<TargetSet>();
  for (const int degrees_of_freedom : {2, 3}) {
    RegistrationOptions options;
    options.degrees_of_freedom = degrees_of_freedom;
    const auto registration = std::make_unique<Registration>(options, Pose2{3.0, 0.0, 0.1});
    RegistrationResult result;
    const long count = count_allocations([&] {
      targets->assign(scans.first, {}, {}, counters);
      registration->set_previous(*targets);
      targets->assign(scans.second, {}, {}, counters);
      result = registration->solve(*targets, kDt);
    });
    CHECK(count == 0);
    CHECK(targets->size() == kMaxDetections);
    CHECK(result.status == RegistrationStatus::converged);
    CHECK(result.iterations > 2);
  }
}

TEST_CASE("repeated searches and too many pairs do not allocate") {
  // Two full scans: of different places, which repeats the search, or with more possible pairs than
  // the association's capacity.
  struct Row {
    std::string what;
    double max_range_m;
    std::uint64_t second_seed;
    double azimuth_std_rad;
    bool searches_again;
  };
  const std::vector<Row> rows = {{"another place", 60.0, 2, 0.0157, true},
                                 {"dense", 6.0, 1, 0.0157, false},
                                 {"all pairs are possible", 60.0, 2, 0.5, false}};
  for (const Row& row : rows) {
    const auto targets = [&](std::uint64_t seed) {
      Random random(seed);
      return simulation::targets(
          simulation::observe_all(
              simulation::scatter(random, kMaxDetections, 2.0, row.max_range_m, radians(60.0), 0.0),
              Eigen::Vector3d::Zero(), kDt, {}, {0.13, row.azimuth_std_rad, 0.3}),
          {});
    };
    const TargetSet previous = targets(1);
    const TargetSet current = targets(row.second_seed);
    for (const Likelihood model : {Likelihood::exclusive, Likelihood::max_sum_mixture}) {
      RegistrationOptions options;
      options.likelihood = model;
      options.degrees_of_freedom = 3;
      options.max_component_evaluations = 100'000'000;
      const auto registration = std::make_unique<Registration>(options, Pose2{});
      RegistrationResult result;
      CHECK(count_allocations([&] {
              registration->set_previous(previous);
              result = registration->solve(current, kDt);
            }) == 0);
      CAPTURE(row.what, model);
      if (model == Likelihood::exclusive) {
        CHECK((result.starts > 1) == row.searches_again);
      }
    }
  }
}

TEST_CASE("a full association does not allocate") {
  const auto association = std::make_unique<Association>();
  CHECK(count_allocations([&] {
          association->clear(kMaxDetections);
          for (std::size_t i = 0; i < kMaxDetections; ++i) {
            association->begin_row();
            for (std::size_t j = 0; j < 20; ++j) {
              association->add((i + j) % kMaxDetections, 1e5, Eigen::Vector3d::UnitX());
            }
          }
          association->start();
          association->solve();
          association->missing_information(Eigen::Vector3d::Ones());
        }) == 0);
  CHECK(association->size() == Association::kMaxPairs);
}

TEST_CASE("the estimator does not allocate with any kind of scan") {
  const Scans scans = full_scans();
  RadarScan incomplete = scans.second;
  incomplete.status = ScanStatus::conflicting_parts;
  RadarScan broken = scans.second;
  broken.detections[7].range_m = numeric::kNan;
  RadarScan late = scans.second;
  late.stamp_us += 60000000;
  EgoMotionOptions options;
  options.registration.degrees_of_freedom = 3;
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  struct Row {
    const RadarScan& scan;
    MotionStatus status;
  };
  const RadarScan nothing;
  const Row rows[] = {
      {scans.first, MotionStatus::no_reference}, {incomplete, MotionStatus::incomplete_scan},
      {broken, MotionStatus::non_finite},        {nothing, MotionStatus::too_few_targets},
      {scans.second, MotionStatus::ok},          {late, MotionStatus::gap_too_long}};
  for (const Row& row : rows) {
    EgoMotion motion;
    CHECK(count_allocations([&] { motion = estimator->update(row.scan); }) == 0);
    CHECK(motion.status == row.status);
  }
}

TEST_CASE("self-check does not allocate with any kind of motion") {
  const EgoMotionOptions options = simulation::drawn_options(2);
  simulation::DrawnVehicle vehicle(simulation::in_bends, simulation::drawn_radars(1), options, 1);
  const auto check = std::make_unique<SelfCheck>(options);
  const TargetSet targets;  // test_hot_path covers the speed check.
  long count = 0;
  while (vehicle.time_s() < 20.0) {
    simulation::DrawnMotion drawn = vehicle.next();
    if (drawn.motion.has_estimate() && vehicle.time_s() > 8.0) {
      drawn.motion.motion.x() += drawn.motion.utime_us / 75'000 % 2 == 0 ? 0.5 : -0.5;  // A fault.
    }
    count += count_allocations([&] { check->add(drawn.motion, targets); });
  }
  CHECK(count == 0);
  CHECK(check->doubts() != 0);
  CHECK(count_allocations([&] { check->forget(); }) == 0);
}

TEST_CASE("a state with faults does not allocate") {
  GaussianState state(Innovation::kMaxStates, true);
  for (int i = 0; i < state.size(); ++i) {
    state.set(i, 0.0, 1.0);
  }
  LinearMeasurement measurement;
  measurement.residual.x() = 1.0;
  measurement.depend_on(0, 1.0);
  measurement.by_faults(0, 3) = 1.0;
  const Eigen::Matrix<double, 3, 2> by = Eigen::Matrix<double, 3, 2>::Ones();
  CHECK(count_allocations([&] {
          for (int i = 0; i < 3; ++i) {
            state.update(state.innovate(measurement), {});
            const auto first = Eigen::seqN(0, Eigen::fix<2>);
            const auto clone = Eigen::seqN(4, Eigen::fix<3>);
            state.set_to(first, Eigen::Vector2d(1.0, 2.0), first, Eigen::Matrix2d(by.topRows<2>()),
                         Eigen::Matrix2d(Eigen::Matrix2d::Identity()));
            state.set_to(clone, Eigen::Vector3d(1.0, 1.0, 1.0), first, by);
            state.set_to(clone, Eigen::Vector3d(1.0, 1.0, 1.0), std::array{0, 5}, by);
            state.correct_faults(3, Eigen::Vector3d::Ones(), Eigen::Matrix3d::Identity());
            state.forget_faults(3);
          }
        }) == 0);
}

TEST_CASE("the odometry filter does not allocate with any kind of scan") {
  simulation::OdometryDrive drive(
      {{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.05}, {-0.6, -0.6, -3.05}, {2.4, 0.8, 1.55}}, 1);
  const TargetSet nothing;
  long count = 0;
  int registered = 0;
  const auto update = [&](std::size_t radar, const TargetSet& targets, std::int64_t stamp_us) {
    Odometry odometry;
    count += count_allocations([&] { odometry = drive.filter().update(radar, targets, stamp_us); });
    registered += odometry.status == OdometryStatus::ok ? 1 : 0;
  };
  for (int i = 0; i < 200; ++i) {
    drive.radar(0).world_mps = i > 100 ? 3.0 : 0.0;  // A fault.
    drive.radar(1).world_mps = drive.radar(2).world_mps = i > 150 ? 3.0 : 0.0;
    drive.pass(19000);
    const auto radar = static_cast<std::size_t>(i) % 4;
    update(radar, i % 17 == 16 ? nothing : drive.see(radar), drive.stamp_us() - (i % 3) * 20000);
  }
  drive.pass(20'000'000);
  update(0, drive.see(0), drive.stamp_us());
  CHECK(count == 0);
  CHECK(registered > 100);
  CHECK(count_allocations([&] { drive.filter().forget(); }) == 0);
}

}  // namespace
}  // namespace cremed
