// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/published_figures.hpp"

#include <algorithm>
#include <array>

namespace cremed {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct PublishedRow {
  std::string_view problem;
  std::string_view method;
  Figures figures;
};

constexpr std::array<PublishedRow, 16> kPublished{{
    {"PSR", "MSM", {0.121, 0.99, 1.07}},
    {"PSR", "SA", {0.266, 10.6, kUnknown}},
    {"PSR", "ICP", {0.200, 1.30, 1.31}},
    {"PSR-C", "MSM", {0.097, 0.77, 1.21}},
    {"PSR-C", "ICP", {0.156, 1.07, 1.51}},
    {"Sim", "MSM", {0.052, 0.35, 0.98}},
    {"Sim", "MSM-D", {0.017, 0.35, 1.02}},
    {"Sim", "SA", {0.266, 8.6, kUnknown}},
    {"Sim-C", "MSM", {0.044, 0.29, 1.26}},
    {"Sim-C", "MSM-D", {0.012, 0.28, 1.09}},
    {"NuSc", "MSM", {0.163, 0.154, 1.61}},
    {"NuSc", "MSM-D", {0.0116, 0.105, 3.36}},
    {"NuSc-850", "MSM", {0.168, 0.152, 1.63}},
    {"NuSc-850", "MSM-D", {0.0122, 0.096, 4.49}},
    {"Robot", "MSM", {0.107, 1.12, 2.53}},
    {"Robot", "MSM-D", {0.0110, 1.11, 1.68}},
}};

}  // namespace

Figures figures_of(const Credibility& credibility) {
  return {credibility.rmse_m(), credibility.rmse_deg(), credibility.anees()};
}

Interval consistent_anees(const Credibility& credibility) {
  return anees_interval(credibility.count(), credibility.degrees_of_freedom(), 0.95);
}

Figures published_figures(std::string_view problem, std::string_view method) {
  const auto* const row = std::ranges::find_if(kPublished, [&](const PublishedRow& r) {
    return r.problem == problem && r.method == method;
  });
  return row == kPublished.end() ? Figures{} : row->figures;
}

}  // namespace cremed
