// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/doubt/vehicle/motion_evidence.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"

namespace cremed {

/// Finds an error of the Doppler scale that all radars share: they agree with each other, but by
/// their positions the vehicle drives faster or slower. Two radars at least: of a single one the
/// map shows chance speeds too often.
class CommonScale {
 public:
  explicit CommonScale(std::size_t radars) : doubts_(radars) {}

  /// To be called when the clock of the stamps was set.
  void forget();
  /// A radar's own check finds its speed wrong. `factor`: corrects it, if that is known.
  void note_doubt(std::size_t radar, std::int64_t time_us, std::optional<double> factor) {
    doubts_[radar] = {time_us, factor};
  }
  /// Whether it did within 5 s: an error that all share is found by each within that time.
  [[nodiscard]] bool is_doubted(std::size_t radar, std::int64_t time_us) const;

  struct Finding {
    double factor;    ///< Corrects the Doppler of all radars.
    RadarSet radars;  ///< That share the error.
  };
  /// Each judged radar that is heard needs a factor in the same direction: one in use by its map,
  /// one that is at fault by its own check, if that found it wrong within 5 s. One at fault that
  /// its own check did not accuse tells none, but its Doppler must agree with that of the rest.
  [[nodiscard]] std::optional<Finding> find(const MotionEvidence& evidence, RadarSet at_fault,
                                            RadarSet accused) const;

 private:
  struct Doubt {
    std::optional<std::int64_t> last_us;
    std::optional<double> factor;
  };

  std::vector<Doubt> doubts_;  // By radar.
};

}  // namespace cremed
