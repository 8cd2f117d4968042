// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"
#include "tools/eval/drive/truth_noise.hpp"
#include "tools/laboratory/table/published_figures.hpp"

namespace cremed {

/// Drives to evaluate.
struct RealTableOptions {
  std::string folder;  ///< Output of cremed-convert: one folder per drive.
  std::uint64_t seed = 1;
  unsigned threads = 1;
  TruthNoise truth_noise{};  ///< Of the drives in the folder.
};

/// One method on all drives of one kind.
struct RealRow {
  std::string_view problem;  ///< "NuSc" or "Robot".
  std::string_view method;
  Figures paper;      ///< Of NuSc: the ten scenes of mini.
  Figures paper_850;  ///< Of NuSc: trainval.
  Credibility credibility{2};
  std::size_t left_out = 0;  ///< Pairs without an estimate.
};

struct RealTable {
  struct Odometry {
    std::string_view problem;
    SegmentErrors errors;  ///< Of all drives.
  };

  std::size_t drives = 0;  ///< In the folder.
  std::string note;        ///< On the truth noise in their covariances; may be empty.
  std::vector<RealRow> rows;
  std::vector<Odometry> odometry;  ///< Over the drives: after 1 s, 10 s.
};

/// The paper's fourth experiment with the drives of the folder, and its mobile robot with simulated
/// drives (`cremed-simulate --scenario campus`). Throws UsageError if the folder has no drive,
/// std::runtime_error if a drive cannot be read.
RealTable real_table(const RealTableOptions& options);

}  // namespace cremed
