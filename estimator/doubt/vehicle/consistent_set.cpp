// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/consistent_set.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

namespace cremed {
namespace {

constexpr double kMaxDecreaseToReturn = 4.0;
/// Decrease of chi-square by which one set is better than another.
constexpr double kClearlyBetter = 4.0;

/// The epochs by which a set is judged. The number is that of the worst ones that do not count.
enum class Epochs : std::uint8_t { all = 0, all_but_worst = 1, all_but_two_worst = 2 };

/// Mean decrease of chi-square over the epochs.
double decrease(const MotionEvidence& evidence, const MotionEvidence::ChiSquares& of_set,
                const MotionEvidence::ChiSquares& without, Epochs by) {
  MotionEvidence::ChiSquares decreases{};
  for (std::size_t k = 0; k < of_set.size(); ++k) {
    decreases[k] = of_set[k] - without[k];
  }
  std::size_t counted = evidence.epochs();
  for (int worst = static_cast<int>(by); worst > 0 && counted > 1; --worst, --counted) {
    *std::max_element(decreases.begin(), decreases.end()) = 0.0;
  }
  return std::accumulate(decreases.begin(), decreases.end(), 0.0) / static_cast<double>(counted);
}

bool is_consistent(const MotionEvidence& evidence, RadarSet set, RadarSet at_fault, Epochs by,
                   std::optional<MotionEvidence::Pair> pair = std::nullopt,
                   MotionEvidence::Slip slip = MotionEvidence::Slip::usual) {
  const auto of_set = evidence.chi_squares(set, pair, slip);
  return !any_of(set, [&](std::size_t radar) {
    const double limit = contains(at_fault, radar) ? kMaxDecreaseToReturn : kMaxDecrease;
    const auto without = evidence.chi_squares(set & ~set_of(radar), pair, slip);
    return decrease(evidence, of_set, without, by) > limit;
  });
}

class Search {
  using Slip = MotionEvidence::Slip;

 public:
  Search(const MotionEvidence& evidence, RadarSet at_fault, const SlipRule& rule)
      : evidence_(evidence), at_fault_(at_fault), rule_(rule) {}

  [[nodiscard]] ConsistentSet find() {
    const RadarSet present = evidence_.present();
    if (present == 0) {
      return {evidence_.judged()};
    }
    // All radars are believed while that explains the measurements.
    try_believed(present);
    const bool is_slip_in_question = best_.radars == 0 && slips_as_none(present);
    best_.agrees_on_slip =
        is_slip_in_question && rule_.may_be_common && agree_on_slip(evidence_, present);
    if (best_.radars == 0 && !best_.agrees_on_slip) {
      slip_ = is_slip_in_question ? Slip::usual_by_positions : Slip::usual;
      try_less(present);
    }
    best_.radars |= best_.radars != 0 ? evidence_.judged() & ~present & ~at_fault_ : 0U;
    return best_;
  }

 private:
  void try_less(RadarSet present) {
    try_believed(present & ~at_fault_);
    if (best_.radars == 0 || do_witnesses_contradict()) {
      try_all(present);
    }
    if (std::popcount(present) > 2) {
      try_exchanged(present);
    }
  }

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

  /// Tries whether all measurements fit if two radars have each other's mounts. If a set without
  /// one radar also fits, that is as simple an explanation (its Doppler may have the wrong sign);
  /// then the witnesses decide. Positions of the two do not count: they were registered at wrong
  /// mounts.
  void try_exchanged(RadarSet present) {
    ConsistentSet exchanged;
    double of_witnesses = 0.0;
    for_each(present, [&](std::size_t one) {
      for_each(present & ~(2U * set_of(one) - 1U), [&](std::size_t other) {
        const MotionEvidence::Pair pair{one, other, true};
        const auto fit = evidence_.fit(present, pair);
        const auto own = evidence_.fit(present, MotionEvidence::Pair{one, other, false});
        if (fit.of_witnesses < kMaxWitness && own.of_set - fit.of_set > kMaxDecrease &&
            is_consistent(evidence_, present, 0U, Epochs::all, pair)) {
          exchanged = {present & ~set_of(one) & ~set_of(other), fit.chi_square(),
                       exchanged.radars == 0 ? 0 : exchanged.rivals + 1};
          of_witnesses = fit.of_witnesses;
        }
      });
    });
    if (exchanged.radars == 0 || exchanged.rivals > 0) {
      return;
    }
    const bool is_as_simple = std::popcount(best_.radars) + 1 == std::popcount(present);
    const double gain =
        is_as_simple ? evidence_.fit(best_.radars).of_witnesses - of_witnesses : kMaxWitness;
    if (gain > kClearlyBetter) {
      best_ = exchanged;
    } else {
      best_.is_exchange_possible = gain > -kClearlyBetter && evidence_.witnesses() != 0;
    }
  }

  /// Whether more than one witness contradicts: a single one may see a passing vehicle.
  [[nodiscard]] bool do_witnesses_contradict() const {
    return evidence_.fit(best_.radars).of_witnesses > kMaxWitness;
  }

  /// Leaves out the worst epoch, so that one wrong registration of two scans (0.98 +- 0.06 instead
  /// of 0.48 rad/s, on 1094 with 0.45 of its targets) does not change what is believed. A radar at
  /// fault must be consistent in all epochs to return.
  void try_believed(RadarSet set) {
    try_set(set, (set & at_fault_) == 0 ? Epochs::all_but_worst : Epochs::all);
  }

  /// A single radar tells it by its own chi-square.
  [[nodiscard]] bool slips_as_none(RadarSet set) const {
    return std::popcount(set) > 1 && evidence_.decrease_by_slip(set) > rule_.max_decrease;
  }

  void try_set(RadarSet set, Epochs by = Epochs::all) {
    if (set == 0 || !is_consistent(evidence_, set, at_fault_, by, std::nullopt, slip_) ||
        slips_as_none(set)) {
      return;
    }
    const double fit = evidence_.fit(set, {}, slip_).chi_square();
    // Of two single radars, each confirmed by its own positions, neither is better.
    const double clearly_better =
        std::has_single_bit(set) ? std::numeric_limits<double>::infinity() : kClearlyBetter;
    if (best_.radars == 0 || fit < best_.chi_square - clearly_better) {
      best_ = {set, fit, 0};
    } else if (fit <= best_.chi_square + clearly_better) {
      best_ = {fit < best_.chi_square ? set : best_.radars, std::min(fit, best_.chi_square),
               best_.rivals + 1};
    }
  }

  /// Takes a smaller set if the witnesses contradict it less than the best one, by more than
  /// kMaxWitness for each radar fewer: two exchanged radars, one ahead and one behind, agree that
  /// the vehicle drives backwards.
  void try_smaller(RadarSet set) {
    const int fewer = std::popcount(best_.radars) - std::popcount(set);
    if (set == 0 || fewer <= 0) {
      return;
    }
    const MotionEvidence::Fit fit = evidence_.fit(set, {}, slip_);
    const double gain = evidence_.fit(best_.radars, {}, slip_).of_witnesses - fit.of_witnesses -
                        kMaxWitness * fewer;
    if (gain <= 0.0 ||
        !is_consistent(evidence_, set, at_fault_, Epochs::all, std::nullopt, slip_) ||
        slips_as_none(set)) {
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
  SlipRule rule_;
  Slip slip_ = Slip::usual;
  ConsistentSet best_;
};

}  // namespace

bool is_consistent(const MotionEvidence& evidence, RadarSet set, RadarSet at_fault) {
  return is_consistent(evidence, set, at_fault, Epochs::all);
}

bool agree_on_slip(const MotionEvidence& evidence, RadarSet set) {
  // The limit is that of radars at fault: without it two radars of three that are turned by 5
  // degrees agree with the third. The two worst epochs are left out: in a skid registrations fail.
  return std::popcount(set) > 1 && is_consistent(evidence, set, set, Epochs::all_but_two_worst,
                                                 std::nullopt, MotionEvidence::Slip::any);
}

ConsistentSet find_consistent_set(const MotionEvidence& evidence, RadarSet at_fault,
                                  const SlipRule& slip) {
  return Search(evidence, at_fault, slip).find();
}

}  // namespace cremed
