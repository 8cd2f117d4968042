// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/consistent_set.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace cremed {
namespace {

constexpr double kMaxDecreaseToReturn = 4.0;
/// Decrease of chi-square by which one set is better than another.
constexpr double kClearlyBetter = 4.0;

bool is_consistent(const MotionEvidence& evidence, RadarSet set, double chi_square_of_set,
                   RadarSet at_fault) {
  return !any_of(set, [&](std::size_t radar) {
    const RadarSet without = set & ~set_of(radar);
    const double limit = contains(at_fault, radar) ? kMaxDecreaseToReturn : kMaxDecrease;
    return chi_square_of_set - (without == 0 ? 0.0 : evidence.fit(without).chi_square()) > limit;
  });
}

class Search {
 public:
  Search(const MotionEvidence& evidence, RadarSet at_fault)
      : evidence_(evidence), at_fault_(at_fault) {}

  [[nodiscard]] ConsistentSet find() {
    const RadarSet present = evidence_.present();
    if (present == 0) {
      return {evidence_.judged()};
    }
    // That of before is kept while it explains the measurements.
    try_set(present);
    if (best_.radars == 0) {
      try_set(present & ~at_fault_);
    }
    if (best_.radars == 0 || (best_.radars != present && do_witnesses_contradict())) {
      try_all(present);
    }
    best_.radars |= best_.radars != 0 ? evidence_.judged() & ~present & ~at_fault_ : 0U;
    return best_;
  }

 private:
  void try_all(RadarSet present) {
    best_ = {};
    const auto each = [&](auto use) {
      for_each(present, [&](std::size_t one) { use(set_of(one)); });
    };
    const auto each_pair_less = [&](auto use) {
      each([&](RadarSet one) {
        each([&](RadarSet other) { use(other > one ? present & ~one & ~other : 0U); });
      });
    };
    const auto try_set = [this](RadarSet set) { this->try_set(set); };
    each([&](RadarSet one) { try_set(present & ~one); });
    if (best_.radars == 0) {
      each_pair_less(try_set);
    }
    if (best_.radars == 0) {
      each(try_set);
    }
    if (best_.radars != 0 && do_witnesses_contradict()) {
      const auto try_smaller = [this](RadarSet set) { this->try_smaller(set); };
      each_pair_less(try_smaller);
      each(try_smaller);
    }
  }

  [[nodiscard]] bool do_witnesses_contradict() const {
    return evidence_.fit(best_.radars).of_witnesses > kMaxDecrease;
  }

  void try_set(RadarSet set) {
    if (set == 0) {
      return;
    }
    const double fit = evidence_.fit(set).chi_square();
    if (!is_consistent(evidence_, set, fit, at_fault_)) {
      return;
    }
    // Of two single radars that are each right by their own none is better.
    const double clearly_better =
        std::has_single_bit(set) ? std::numeric_limits<double>::infinity() : kClearlyBetter;
    if (best_.radars == 0 || fit < best_.chi_square - clearly_better) {
      best_ = {set, fit, 0};
    } else if (fit <= best_.chi_square + clearly_better) {
      best_ = {fit < best_.chi_square ? set : best_.radars, std::min(fit, best_.chi_square),
               best_.rivals + 1};
    }
  }

  /// The witnesses contradict the best set by more than a radar may, and not this smaller one: two
  /// exchanged radars, one ahead and one behind, agree that the vehicle drives backwards.
  void try_smaller(RadarSet set) {
    const int fewer = std::popcount(best_.radars) - std::popcount(set);
    if (set == 0 || fewer <= 0) {
      return;
    }
    const MotionEvidence::Fit fit = evidence_.fit(set);
    const double gain =
        evidence_.fit(best_.radars).of_witnesses - fit.of_witnesses - kMaxDecrease * fewer;
    if (gain <= 0.0 || !is_consistent(evidence_, set, fit.chi_square(), at_fault_)) {
      return;
    }
    if (gain > kClearlyBetter) {
      best_ = {set, fit.chi_square(), 0};
    } else {
      ++best_.rivals;
    }
  }

  const MotionEvidence& evidence_;
  RadarSet at_fault_;
  ConsistentSet best_;
};

}  // namespace

bool is_consistent(const MotionEvidence& evidence, RadarSet set, RadarSet at_fault) {
  return is_consistent(evidence, set, evidence.fit(set).chi_square(), at_fault);
}

ConsistentSet find_consistent_set(const MotionEvidence& evidence, RadarSet at_fault) {
  return Search(evidence, at_fault).find();
}

}  // namespace cremed
