// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string_view>

namespace cremed {

/// A row of a table of results; NaN where unknown.
struct Figures {
  double rmse_m = std::numeric_limits<double>::quiet_NaN();
  double rmse_deg = std::numeric_limits<double>::quiet_NaN();
  double anees = std::numeric_limits<double>::quiet_NaN();
};

/// The paper's figures (Haggag, Lange, Pfeifer, Protzel, RA-L 2022) for a problem ("PSR", "PSR-C",
/// "Sim", "Sim-C", "NuSc": ten scenes of nuScenes mini, "NuSc-850": trainval, "Robot") and a method
/// ("MSM", "MSM-D", "SA", "SA-D", "ICP").
Figures published_figures(std::string_view problem, std::string_view method);

}  // namespace cremed
