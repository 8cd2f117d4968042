// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/paper_table.hpp"

#include <array>
#include <string>

#include "tools/laboratory/made_in_parallel.hpp"
#include "tools/laboratory/pairs/icp.hpp"
#include "tools/laboratory/pairs/known_correspondences.hpp"
#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/pairs/sum_approximation.hpp"

namespace cremed {
namespace {

/// A method of the table; methods with Doppler run on problems with Doppler (2 DoF) only.
struct TableMethod {
  std::string_view name;
  std::string_view published;  // what the paper calls it
  bool doppler;
  RegisterFunction solve;
  Likelihood likelihood;
  bool is_always_3dof = false;
};

constexpr std::array<TableMethod, 7> kTableMethods{{
    {"MSM", "MSM", false, register_msm, Likelihood::exclusive},
    {"MSM-D", "MSM-D", true, register_msm, Likelihood::exclusive},
    {"MSM(paper)", "MSM", false, register_msm, Likelihood::max_sum_mixture},
    {"MSM-D(paper)", "MSM-D", true, register_msm, Likelihood::max_sum_mixture},
    {"SA", "SA", false, register_sum_approximation, Likelihood::max_sum_mixture},
    {"SA-D", "SA-D", true, register_sum_approximation, Likelihood::max_sum_mixture},
    {"ICP", "ICP", false, register_icp, Likelihood::max_sum_mixture, true},
}};

/// The pairs of one problem, regenerated for every method: cheaper than storing them.
struct PairSource {
  SimulatedProblem problem;
  std::uint64_t seed;
  std::size_t sets;
  std::size_t runs;

  [[nodiscard]] std::size_t count() const { return sets * runs; }
  [[nodiscard]] RegistrationPair pair(std::size_t i) const {
    return simulated_pair(problem, seed, i / runs, i % runs);
  }
};

PairSource pair_source(SimulatedProblem problem, const PaperTableOptions& options) {
  const SimulatedProblemSettings& paper = settings(problem);
  return {problem, options.seed, options.sets == 0 ? paper.sets : options.sets,
          options.runs == 0 ? paper.runs : options.runs};
}

/// `solve`(pair) for every pair, in their order for any number of threads.
template <typename Solve>
std::vector<PairResult> run(const PairSource& source, unsigned threads, std::string_view name,
                            const Solve& solve) {
  const std::string label = std::string(settings(source.problem).name).append(" ").append(name);
  return made_in_parallel(label, source.count(), threads,
                          [&](std::size_t i) { return solve(source.pair(i)); });
}

Figures run_bound(const PairSource& source, unsigned threads, const RegistrationOptions& options) {
  const auto results = run(source, threads, "bound", [&](const RegistrationPair& pair) {
    return PairResult{register_known(pair, options),
                      {pair.truth.x_m, pair.truth.y_m, pair.truth.yaw_rad}};
  });
  return figures_of(pairs_figures(results, options.degrees_of_freedom).credibility);
}

TableRow run_method(const PairSource& source, unsigned threads, const TableMethod& method,
                    const Figures& bound) {
  const SimulatedProblemSettings& problem = settings(source.problem);
  const RegistrationOptions options = *profile(problem.profile, method.doppler, method.likelihood);
  const auto solve = [&](const RegistrationPair& pair) {
    return solve_pair(pair, options, method.solve);
  };
  return {pairs_figures(run(source, threads, method.name, solve),
                        method.is_always_3dof ? 3 : problem.degrees_of_freedom),
          problem.name, method.name, published_figures(problem.name, method.published), bound};
}

}  // namespace

std::vector<TableRow> paper_table(const PaperTableOptions& options) {
  std::vector<TableRow> rows;
  for (const SimulatedProblem problem : kSimulatedProblems) {
    const SimulatedProblemSettings& chosen = settings(problem);
    const bool has_doppler = chosen.degrees_of_freedom == 2;
    const PairSource source = pair_source(problem, options);
    const auto bound = [&](bool doppler) {
      return run_bound(source, options.threads, *profile(chosen.profile, doppler));
    };
    const std::array<Figures, 2> bounds{bound(false), has_doppler ? bound(true) : Figures{}};
    for (const TableMethod& method : kTableMethods) {
      if (has_doppler || !method.doppler) {
        rows.push_back(run_method(source, options.threads, method, bounds[method.doppler ? 1 : 0]));
      }
    }
  }
  return rows;
}

}  // namespace cremed
