// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/laboratory/pairs/known_correspondences.hpp"
#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/table/simulated_pairs.hpp"

using namespace cremed;

namespace {

Credibility bound(SimulatedProblem problem, bool doppler, std::uint64_t seed) {
  const RegistrationOptions options = *profile(settings(problem).profile, doppler);
  Credibility credibility(options.degrees_of_freedom);
  for (const RegistrationPair& pair : simulated_pairs(problem, seed, 50, 10)) {
    const RegistrationResult result = register_known(pair, options);
    REQUIRE(result.status == RegistrationStatus::converged);
    credibility.add(result.motion, result.covariance,
                    {pair.truth.x_m, pair.truth.y_m, pair.truth.yaw_rad});
  }
  return credibility;
}

}  // namespace

TEST_CASE("Who knows the correspondences has a credible covariance") {
  struct Row {
    SimulatedProblem problem;
    bool doppler;
    double rmse_m;
    double rmse_deg;
  };
  // Figures of 100000 (25000) pairs.
  const auto row = GENERATE(Row{SimulatedProblem::psr, false, 0.1178, 0.963},
                            Row{SimulatedProblem::psr_c, false, 0.0883, 0.718},
                            Row{SimulatedProblem::sim, false, 0.0531, 0.356},
                            Row{SimulatedProblem::sim, true, 0.0163, 0.355},
                            Row{SimulatedProblem::sim_c, true, 0.0122, 0.269});
  CAPTURE(settings(row.problem).name, row.doppler);
  const Credibility credibility = bound(row.problem, row.doppler, 11);
  const Interval interval =
      anees_interval(credibility.count(), settings(row.problem).degrees_of_freedom, 0.999);
  CHECK(credibility.anees() > interval.low);
  CHECK(credibility.anees() < interval.high);
  CHECK(credibility.rmse_m() == Approx(row.rmse_m).epsilon(0.15));
  CHECK(credibility.rmse_deg() == Approx(row.rmse_deg).epsilon(0.15));
}

TEST_CASE("Targets without a partner do not count, and too few partners are degenerate") {
  RegistrationPair pair = simulated_pair(SimulatedProblem::psr, 1, 0, 0);
  const RegistrationOptions options = *profile("psr", false);
  const RegistrationResult all = register_known(pair, options);
  Detection stranger = pair.current.front();
  stranger.id = 1000;
  stranger.range_m += 3.0;
  pair.current.push_back(stranger);
  CHECK(register_known(pair, options).motion == all.motion);

  for (Detection& detection : pair.current) {
    detection.id = static_cast<std::uint16_t>(detection.id + 2000);
  }
  CHECK(register_known(pair, options).status == RegistrationStatus::degenerate);
}
