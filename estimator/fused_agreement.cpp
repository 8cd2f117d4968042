// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "estimator/fused_estimator.hpp"
#include "estimator/normal_equations.hpp"

// Which radars agree, and which one to leave out.
namespace cremed {
namespace {

/// A radar's mean innovation that tells it to be wrong: if all of its error stayed the same for a
/// minute, chance would still exceed 5.4 once in 1000 only.
constexpr double kContradiction = 5.0;
/// It is believed again below this.
constexpr double kAgreement = 3.0;
/// Of two radars that contradict each other one is plainly wrong if it does so by such a factor
/// more against all else that is known: else nobody can tell, and neither is used.
constexpr double kPlainly = 3.0;

}  // namespace

void RadarAgreement::judge() {
  contradicts = innovation.exceeds(contradicts ? kAgreement : kContradiction);
}

void RadarAgreement::forgive() {
  innovation.clear();
  contradicts = false;
}

/// Normalised innovation squared, a degree of freedom, of what one radar says against all else;
/// nothing if one of them does not say enough.
std::optional<double> FusedEstimator::innovation(const Sums& own, const Sums& others) {
  const auto own_covariance = invert_information(own.information, 3);
  const auto covariance = invert_information(others.information, 3);
  if (!own_covariance || !covariance) {
    return std::nullopt;
  }
  const Eigen::Vector3d difference = *own_covariance * own.weighted - *covariance * others.weighted;
  const auto weight = invert_information(*own_covariance + *covariance, 3);
  return weight ? std::optional(difference.dot(*weight * difference) / 3.0) : std::nullopt;
}

FusedEstimator::Sums FusedEstimator::own_sum(std::size_t radar) const {
  Sums sums;
  for (std::size_t i = 0; i < count_; ++i) {
    if (measurements_[i].is_used && measurements_[i].radar == radar) {
      sums.add(measurements_[i].information, measurements_[i].twist.mean);
    }
  }
  return sums;
}

/// Besides what is known without any radar.
FusedEstimator::Sums FusedEstimator::sum_of_others(std::size_t radar, Sums known) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (measurements_[i].is_used && measurements_[i].radar != radar) {
      known.add(measurements_[i].information, measurements_[i].twist.mean);
    }
  }
  return known;
}

/// The radar that contradicts the others most, if one does and another is left. Whoever has
/// contradicted before is likelier to be the one that does now: without that memory the wrong one
/// of two would some day be left out, and the other then be what everything is compared with. Two
/// contradict each other alike: what the vehicle did before must tell which is wrong.
FusedEstimator::Contradiction FusedEstimator::contradiction(const Sums& known) const {
  std::size_t radars = 0;
  bool is_any = false;
  Contradiction by_others;
  Contradiction by_past;
  for (std::size_t radar = 0; radar < radars_; ++radar) {
    const Sums own = own_sum(radar);
    if (own.information.isZero(0.0)) {
      continue;
    }
    ++radars;
    const double record = 1.0 + agreements_[radar].innovation.mean();
    const double nis = innovation(own, sum_of_others(radar, known)).value_or(0.0);
    is_any = is_any || nis > options_.max_innovation;
    by_others.note(radar, record * nis);
    by_past.note(radar, record * (1.0 + innovation(own, known).value_or(0.0)));
  }
  Contradiction result = radars > 2 ? by_others : by_past;
  result.is_any = is_any && radars >= 2;
  result.is_plain = radars > 2 || by_past.worst > kPlainly * by_past.second;
  return result;
}

void FusedEstimator::Contradiction::note(std::size_t which, double score) {
  second = std::max(second, std::min(worst, score));
  radar = score > worst ? which : radar;
  worst = std::max(worst, score);
}

/// All its motions at once: they err alike, and two of them would outvote one of another radar.
void FusedEstimator::leave_out(std::size_t radar) {
  for (std::size_t i = 0; i < count_; ++i) {
    measurements_[i].is_used = measurements_[i].is_used && measurements_[i].radar != radar;
  }
}

void FusedEstimator::note_agreement(const Sums& known) {
  for (std::size_t i = 0; i < count_; ++i) {
    const Measurement& m = measurements_[i];
    RadarAgreement& agreement = agreements_[m.radar];
    ++(m.is_used ? agreement.used : agreement.left_out);
    Sums own;
    own.add(m.information, m.twist.mean);
    if (const auto nis = innovation(own, sum_of_others(m.radar, known))) {
      agreement.innovation.add(last_scan_us_[m.radar], *nis);
    }
    agreement.judge();
  }
}

}  // namespace cremed
