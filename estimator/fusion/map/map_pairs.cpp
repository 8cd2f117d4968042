// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/map/map_pairs.hpp"

#include <array>

#include "cremed/estimator/cost/vector_math.hpp"

namespace cremed {

using namespace vector_math;

namespace {

/// Squared distance in sigmas beyond which a pair's weight, 4e-6 of its greatest, is left out.
constexpr double kNoPartner = 25.0;

}  // namespace

MapPairs::MapPairs() {
  static_assert(kMaxPairs % kLanes == 0);  // pad() does not exceed it.
  for (auto* column : {&x_m_, &y_m_, &azimuth_rad_, &xx_, &xy_, &yy_, &density_, &weight_}) {
    column->resize(kMaxPairs);
  }
  node_.resize(kMaxPairs);
}

void MapPairs::add(const TargetMap::Placed& placed, const Symmetric2& information, double density) {
  const std::size_t k = size_++;
  x_m_[k] = placed.at_m.x();
  y_m_[k] = placed.at_m.y();
  azimuth_rad_[k] = placed.azimuth_rad;
  node_[k] = placed.node;
  xx_[k] = information.xx;
  xy_[k] = information.xy;
  yy_[k] = information.yy;
  density_[k] = density;
}

void MapPairs::pad() {
  while (size_ % kLanes != 0) {
    add({Eigen::Vector2d::Zero(), {}, 0.0, 0, -1}, {}, 0.0);
  }
}

/// Lane by lane, so that the order of the sums does not depend on the vector width.
template <typename Pack>
CREMED_ALWAYS_INLINE PairSums MapPairs::sum_up_packs(std::size_t begin, std::size_t end,
                                                     const Eigen::Vector2d& at_m) {
  using Double = typename Pack::Double;
  constexpr std::size_t kParts = kLanes / Pack::kDoubles;
  using Sums = std::array<Double, kParts>;
  Sums w_sum, xx_sum, xy_sum, yy_sum, fx_sum, fy_sum, fxx_sum, fxy_sum, fyy_sum;
  const double at_x = at_m.x();
  const double at_y = at_m.y();
  for (std::size_t part = 0; part < kParts; ++part) {
    Double ws{}, xxs{}, xys{}, yys{}, fxs{}, fys{}, fxxs{}, fxys{}, fyys{};
    for (std::size_t k = begin + part * Pack::kDoubles; k < end; k += kLanes) {
      const auto xx = load<Double>(&xx_[k]);
      const auto xy = load<Double>(&xy_[k]);
      const auto yy = load<Double>(&yy_[k]);
      const Double ex = at_x - load<Double>(&x_m_[k]);
      const Double ey = at_y - load<Double>(&y_m_[k]);
      const Double fx = xx * ex + xy * ey;
      const Double fy = xy * ex + yy * ey;
      const Double squared_distance = ex * fx + ey * fy;
      const Double density =
          load<Double>(&density_[k]) * exponential<Pack>(-0.5 * squared_distance);
      const Double w = squared_distance < kNoPartner ? density : Double{};
      store(&weight_[k], w);
      const Double wfx = w * fx;
      const Double wfy = w * fy;
      ws += w;
      xxs += w * xx;
      xys += w * xy;
      yys += w * yy;
      fxs += wfx;
      fys += wfy;
      fxxs += wfx * fx;
      fxys += wfx * fy;
      fyys += wfy * fy;
    }
    w_sum[part] = ws;
    xx_sum[part] = xxs;
    xy_sum[part] = xys;
    yy_sum[part] = yys;
    fx_sum[part] = fxs;
    fy_sum[part] = fys;
    fxx_sum[part] = fxxs;
    fxy_sum[part] = fxys;
    fyy_sum[part] = fyys;
  }
  const auto total = [](Sums& sums) { return sum(sums); };
  PairSums sums;
  sums.weight = total(w_sum);
  sums.information = {total(xx_sum), total(xy_sum), total(yy_sum)};
  sums.force = {total(fx_sum), total(fy_sum)};
  sums.squared_force = {total(fxx_sum), total(fxy_sum), total(fyy_sum)};
  return sums;
}

PairSums MapPairs::sum_up_plain(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m) {
  return sum_up_packs<Pack<2>>(begin, end, at_m);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] PairSums MapPairs::sum_up_avx2(std::size_t begin, std::size_t end,
                                                       const Eigen::Vector2d& at_m) {
  return sum_up_packs<Pack<4>>(begin, end, at_m);
}

PairSums MapPairs::sum_up(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m) {
  static const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
  return kHasAvx2 ? sum_up_avx2(begin, end, at_m) : sum_up_plain(begin, end, at_m);
}
#else
PairSums MapPairs::sum_up(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m) {
  return sum_up_plain(begin, end, at_m);
}
#endif

}  // namespace cremed
