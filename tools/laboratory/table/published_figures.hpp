// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string_view>

#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"

namespace cremed {

/// A row of a table of results; NaN where unknown.
struct Figures {
  double rmse_m = std::numeric_limits<double>::quiet_NaN();
  double rmse_deg = std::numeric_limits<double>::quiet_NaN();
  double anees = std::numeric_limits<double>::quiet_NaN();
};

Figures figures_of(const Credibility& credibility);

/// 95 % of consistent estimators have their ANEES over as many estimates in it.
Interval consistent_anees(const Credibility& credibility);

/// The paper's figures (Haggag, Lange, Pfeifer, Protzel, RA-L 2022) for a problem ("PSR", "PSR-C",
/// "Sim", "Sim-C", "NuSc": ten scenes of nuScenes mini, "NuSc-850": trainval, "Robot") and a method
/// ("MSM", "MSM-D", "SA", "SA-D", "ICP").
Figures published_figures(std::string_view problem, std::string_view method);

}  // namespace cremed
