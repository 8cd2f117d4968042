// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/doppler_correction.hpp"

namespace cremed {

const TargetSet& DopplerCorrection::corrected(const TargetSet& targets) {
  if (!is_learned()) {
    return targets;
  }
  corrected_.clear();
  for (Target target : targets) {
    target.doppler_mps *= factor_;
    corrected_.add(target);
  }
  return corrected_;
}

}  // namespace cremed
