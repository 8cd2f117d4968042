// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/median.hpp"
#include "test/data_tests/shared_data.hpp"
#include "test/estimator/simulation.hpp"
#include "tools/eval/csv_table.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"
#include "tools/laboratory/pairs/profile.hpp"

using namespace cremed;

namespace {

struct ReferencePairs {
  const char* pairs;
  const char* reference;
  const char* profile;
  bool doppler;
  double max_median_difference;  // m and rad
};

std::vector<RegistrationResult> read_reference(const std::string& name) {
  std::istringstream text(read_shared(name));
  const CsvTable table(text);
  std::vector<RegistrationResult> results;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](const char* column) { return table.number(row, table.column(column)); };
    RegistrationResult result;
    result.status = RegistrationStatus::converged;
    result.motion << number("x"), number("y"), number("yaw");
    result.covariance << number("cxx"), number("cxy"), number("cxt"),  //
        number("cxy"), number("cyy"), number("cyt"),                   //
        number("cxt"), number("cyt"), number("ctt");
    results.push_back(result);
  }
  return results;
}

/// Our cost at another implementation's motion.
double cost_at(const RegistrationPair& pair, const RegistrationOptions& options,
               const Eigen::Vector3d& motion) {
  const Pose2& mount = pair.vehicle_from_radar;
  const TargetSet previous = to_targets(pair.previous, mount);
  const TargetSet current = to_targets(pair.current, mount);
  return simulation::mixture_cost(options, mount, previous, current, pair.dt_s)
      ->linearise({motion})
      .cost;
}

struct Differences {
  double median_m = 0.0;
  double median_rad = 0.0;
  std::size_t different = 0;  // By more than the row's bound in any state.
  std::size_t better = 0;     // Of these: our minimum is lower.
};

Differences compare(const std::vector<RegistrationPair>& pairs, const std::vector<PairResult>& ours,
                    const std::vector<RegistrationResult>& theirs,
                    const RegistrationOptions& options, double bound) {
  Differences result;
  std::vector<double> metres;
  std::vector<double> radians;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const RegistrationResult& our = ours[i].registration;
    const Eigen::Vector3d difference = (our.motion - theirs[i].motion).cwiseAbs();
    metres.push_back(difference.head<2>().maxCoeff());
    radians.push_back(difference.z());
    if (difference.maxCoeff() > bound) {
      ++result.different;
      result.better += our.cost <= cost_at(pairs[i], options, theirs[i].motion) ? 1U : 0U;
    }
  }
  result.median_m = median_or(INFINITY, metres.begin(), metres.end());
  result.median_rad = median_or(INFINITY, radians.begin(), radians.end());
  return result;
}

}  // namespace

TEST_CASE("Registration agrees with the reference implementation, pair by pair") {
  const std::string folder = "data/registration/";
  const auto row =
      GENERATE(ReferencePairs{"psr.csv", "psr.msm.reference.csv", "psr", false, 3e-3},
               ReferencePairs{"psr-c.csv", "psr-c.msm.reference.csv", "psr", false, 3e-3},
               ReferencePairs{"sim.csv", "sim.msm.reference.csv", "sim", false, 3e-4},
               ReferencePairs{"sim.csv", "sim.msm-d.reference.csv", "sim", true, 3e-4},
               ReferencePairs{"sim-c.csv", "sim-c.msm.reference.csv", "sim", false, 3e-4},
               ReferencePairs{"sim-c.csv", "sim-c.msm-d.reference.csv", "sim", true, 3e-4},
               ReferencePairs{"nuscenes-front.csv.xz", "nuscenes-front.msm.reference.csv",
                              "nuscenes", false, 3e-4},
               ReferencePairs{"nuscenes-front.csv.xz", "nuscenes-front.msm-d.reference.csv",
                              "nuscenes", true, 3e-4});
  CAPTURE(row.reference);
  std::istringstream text(read_shared(folder + row.pairs));
  const auto pairs = read_registration_pairs(text);
  const auto options = *profile(row.profile, row.doppler, Likelihood::max_sum_mixture);
  const auto ours = solve_pairs(pairs, options);
  const auto theirs = read_reference(folder + row.reference);
  REQUIRE(ours.size() == theirs.size());

  const PairsFigures figures = pairs_figures(ours, options.degrees_of_freedom);
  CHECK(figures.left_out == 0);
  const Credibility& our = figures.credibility;
  std::vector<PairResult> wrapped = ours;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    wrapped[i].registration = theirs[i];
  }
  const Credibility their = pairs_figures(wrapped, options.degrees_of_freedom).credibility;
  const Differences d = compare(pairs, ours, theirs, options, row.max_median_difference);
  std::printf(
      "%-36s rmse %+.2f %% m, %+.2f %% deg; anees %+.2f %%; median %.1e m %.1e rad; "
      "%zu of %zu differ, %zu of them at a lower cost\n",
      row.reference, 100.0 * (our.rmse_m() / their.rmse_m() - 1.0),
      100.0 * (our.rmse_deg() / their.rmse_deg() - 1.0),
      100.0 * (our.anees() / their.anees() - 1.0), d.median_m, d.median_rad, d.different,
      pairs.size(), d.better);

  // Where the reference's stopping rule (relative cost) ends its slow search early, our minima are
  // lower, and our figures better by up to 5 % (observed: 2.8 % and 4.5 %), never worse.
  const bool is_better_minimum =
      d.median_m > row.max_median_difference &&
      static_cast<double>(d.better) >= 0.99 * static_cast<double>(d.different);
  const double margin = is_better_minimum ? 0.05 : 0.01;
  CHECK(our.rmse_m() <= 1.01 * their.rmse_m());
  CHECK(our.rmse_m() >= (1.0 - margin) * their.rmse_m());
  CHECK(our.rmse_deg() == Approx(their.rmse_deg()).epsilon(0.01));
  CHECK(our.anees() <= 1.02 * their.anees());
  CHECK((our.anees() >= 0.98 * their.anees() ||
         (is_better_minimum && our.anees() >= 0.95 * their.anees())));
  CHECK((d.median_m <= row.max_median_difference || is_better_minimum));
  CHECK(d.median_rad <= row.max_median_difference);
}
