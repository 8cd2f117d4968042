// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/mixture_kernel.hpp"

#include <limits>

#include "cremed/estimator/cost/mixture_gate.hpp"
#include "cremed/estimator/cost/vector_math.hpp"

namespace cremed {
namespace {

using namespace vector_math;
using mixture_gate::kBlock;

constexpr std::size_t kBatch = MixtureScratch::kBatch;

/// Everything but the exponential, for the listed components.
template <typename Pack>
CREMED_ALWAYS_INLINE void find_distances(const MixtureComponents& components,
                                         const MixturePoint& point, MixtureScratch::Terms& terms) {
  using Double = typename Pack::Double;
  const ComponentColumns<double>& c = components.exact;
  const Symmetric2& own = point.covariance_m2;
  std::array<Double, kBlock / Pack::kDoubles> low;
  for (std::size_t part = 0; part < low.size(); ++part) {
    const std::size_t lane = part * Pack::kDoubles;
    Double part_low = Double{} + std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < terms.block_count; ++k) {
      const std::size_t j = kBlock * terms.blocks[k] + lane;
      auto& block = terms.of_block[k];
      const Double ex = point.x_m - load<Double>(&c.x_m[j]);
      const Double ey = point.y_m - load<Double>(&c.y_m[j]);
      const Double cxx = own.xx + load<Double>(&c.xx[j]);
      const Double cxy = own.xy + load<Double>(&c.xy[j]);
      const Double cyy = own.yy + load<Double>(&c.yy[j]);
      const Double root = inverse_root<Pack>(cxx * cyy - cxy * cxy);
      const Double inverse_det = root * root;
      const Double gx = (cyy * ex - cxy * ey) * inverse_det;
      const Double gy = (cxx * ey - cxy * ex) * inverse_det;
      const Double d = ex * gx + ey * gy;
      store(&block.gx[lane], gx);
      store(&block.gy[lane], gy);
      store(&block.squared_distance[lane], d);
      store(&block.scale[lane], load<Double>(&components.weight[j]) * root);
      part_low = d < part_low ? d : part_low;
    }
    low[part] = part_low;
  }
  terms.least_squared_distance = reduce(low, Least());
}

/// Sums over the listed components, and the best component of each lane.
template <typename Pack>
struct LaneSums {
  static constexpr std::size_t kParts = kBlock / Pack::kDoubles;
  using Double = typename Pack::Double;
  using Index = typename Pack::Index;

  std::array<Double, kParts> q;
  std::array<Double, kParts> qgx;
  std::array<Double, kParts> qgy;
  std::array<Double, kParts> best_q;
  std::array<Index, kParts> best;
};

/// Exponents are relative to the nearest component, which avoids underflow and overflow.
template <typename Pack>
CREMED_ALWAYS_INLINE void add_blocks(const MixtureScratch::Terms& terms, LaneSums<Pack>& sums) {
  using Double = typename Pack::Double;
  using Index = typename Pack::Index;
  Index lanes;
  for (std::size_t lane = 0; lane < Pack::kDoubles; ++lane) {
    lanes[lane] = static_cast<std::int64_t>(lane);
  }
  for (std::size_t part = 0; part < LaneSums<Pack>::kParts; ++part) {
    const std::size_t lane = part * Pack::kDoubles;
    Double sum_q{};
    Double sum_qgx{};
    Double sum_qgy{};
    Double best_q = Double{} - 1.0;
    Index best{};
    for (std::size_t k = 0; k < terms.block_count; ++k) {
      auto& block = terms.of_block[k];
      const Double excess =
          load<Double>(&block.squared_distance[lane]) - terms.least_squared_distance;
      const Double q = load<Double>(&block.scale[lane]) * exponential<Pack>(-0.5 * excess);
      sum_q += q;
      sum_qgx += q * load<Double>(&block.gx[lane]);
      sum_qgy += q * load<Double>(&block.gy[lane]);
      const Index is_better = q > best_q;
      best_q = is_better ? q : best_q;
      best =
          is_better ? Index{} + static_cast<std::int64_t>(kBlock * terms.blocks[k] + lane) : best;
    }
    sums.q[part] = sum_q;
    sums.qgx[part] = sum_qgx;
    sums.qgy[part] = sum_qgy;
    sums.best_q[part] = best_q;
    sums.best[part] = best + lanes;
  }
}

/// Of equally good components the first is taken.
template <typename Pack>
CREMED_ALWAYS_INLINE void sum_up(const MixtureScratch::Terms& terms, std::size_t point,
                                 MixtureScratch::Sums& sums) {
  using Index = typename Pack::Index;
  LaneSums<Pack> lanes;
  add_blocks<Pack>(terms, lanes);
  sums.sum_q[point] = reduce(lanes.q, Sum());
  sums.sum_qgx[point] = reduce(lanes.qgx, Sum());
  sums.sum_qgy[point] = reduce(lanes.qgy, Sum());
  auto best_q = lanes.best_q;
  sums.best_q[point] = reduce(best_q, Greatest());
  for (std::size_t part = 0; part < LaneSums<Pack>::kParts; ++part) {
    const Index is_less = lanes.best_q[part] < sums.best_q[point];
    lanes.best[part] |= is_less & static_cast<std::int64_t>(0xffff);
  }
  sums.best[point] = static_cast<std::size_t>(reduce(lanes.best, Least()));
}

/// Inputs and results of the residuals, one column for each quantity.
struct Tail {
  using Lanes = std::array<double, kBatch>;
  alignas(64) Lanes ex;
  alignas(64) Lanes ey;
  alignas(64) Lanes cxx;
  alignas(64) Lanes cxy;
  alignas(64) Lanes cyy;
  alignas(64) Lanes least_squared_distance;
  alignas(64) Lanes best_q;
  alignas(64) Lanes sum_q;
  alignas(64) Lanes sum_qgx;
  alignas(64) Lanes sum_qgy;
  alignas(64) Lanes white_x;
  alignas(64) Lanes white_y;
  alignas(64) Lanes rest;
  alignas(64) Lanes root_xx;
  alignas(64) Lanes root_xy;
  alignas(64) Lanes root_yy;
  alignas(64) Lanes rest_x;
  alignas(64) Lanes rest_y;
  alignas(64) Lanes cost;
};

/// Columns without a point repeat the first one.
CREMED_ALWAYS_INLINE void gather(const MixtureComponents& components,
                                 std::span<const MixturePoint> points,
                                 const MixtureScratch& scratch, Tail& tail) {
  const ComponentColumns<double>& c = components.exact;
  for (std::size_t i = 0; i < kBatch; ++i) {
    const std::size_t from = i < points.size() ? i : 0;
    const MixturePoint& point = points[from];
    const std::size_t j = scratch.sums.best[from];
    tail.ex[i] = point.x_m - c.x_m[j];
    tail.ey[i] = point.y_m - c.y_m[j];
    tail.cxx[i] = point.covariance_m2.xx + c.xx[j];
    tail.cxy[i] = point.covariance_m2.xy + c.xy[j];
    tail.cyy[i] = point.covariance_m2.yy + c.yy[j];
    tail.least_squared_distance[i] = scratch.terms[from].least_squared_distance;
    tail.best_q[i] = scratch.sums.best_q[from];
    tail.sum_q[i] = scratch.sums.sum_q[from];
    tail.sum_qgx[i] = scratch.sums.sum_qgx[from];
    tail.sum_qgy[i] = scratch.sums.sum_qgy[from];
  }
}

/// Residuals of the best component, whitened by L with L'L = C^-1 (L upper triangular), and of the
/// rest of the mixture.
template <typename Pack>
CREMED_ALWAYS_INLINE void finish(double log_damped_size, Tail& tail) {
  using Double = typename Pack::Double;
  for (std::size_t i = 0; i < kBatch; i += Pack::kDoubles) {
    const auto ex = load<Double>(&tail.ex[i]);
    const auto ey = load<Double>(&tail.ey[i]);
    const auto cxx = load<Double>(&tail.cxx[i]);
    const auto cxy = load<Double>(&tail.cxy[i]);
    const auto cyy = load<Double>(&tail.cyy[i]);
    const auto sum_q = load<Double>(&tail.sum_q[i]);
    const Double root_det = inverse_root<Pack>(cxx * cyy - cxy * cxy);
    const Double root_yy = inverse_root<Pack>(cyy);
    const Double xx = cyy * root_yy * root_det;
    const Double xy = -cxy * root_yy * root_det;
    const Double inverse_sum = 1.0 / sum_q;
    const Double log_share = logarithm<Pack>(sum_q / load<Double>(&tail.best_q[i]));
    const Double squared_rest = 2.0 * (log_damped_size - log_share);
    const Double inverse_rest = inverse_root<Pack>(squared_rest);
    const Double inverse_det = root_det * root_det;
    const Double gx = (cyy * ex - cxy * ey) * inverse_det;
    const Double gy = (cxx * ey - cxy * ex) * inverse_det;
    store(&tail.white_x[i], xx * ex + xy * ey);
    store(&tail.white_y[i], root_yy * ey);
    store(&tail.rest[i], squared_rest * inverse_rest);
    store(&tail.root_xx[i], xx);
    store(&tail.root_xy[i], xy);
    store(&tail.root_yy[i], root_yy);
    store(&tail.rest_x[i], (load<Double>(&tail.sum_qgx[i]) * inverse_sum - gx) * inverse_rest);
    store(&tail.rest_y[i], (load<Double>(&tail.sum_qgy[i]) * inverse_sum - gy) * inverse_rest);
    store(&tail.cost[i],
          0.5 * load<Double>(&tail.least_squared_distance[i]) - logarithm<Pack>(sum_q));
  }
}

CREMED_ALWAYS_INLINE void scatter(const Tail& tail, const MixtureScratch::Sums& sums,
                                  std::span<MixtureResidual> residuals) {
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    MixtureResidual& residual = residuals[i];
    double* r = residual.residual.data();
    r[0] = tail.white_x[i];
    r[1] = tail.white_y[i];
    r[2] = tail.rest[i];
    double* j = residual.jacobian.data();
    j[0] = tail.root_xx[i];
    j[1] = 0.0;
    j[2] = tail.rest_x[i];
    j[3] = tail.root_xy[i];
    j[4] = tail.root_yy[i];
    j[5] = tail.rest_y[i];
    residual.cost = tail.cost[i];
    residual.component = sums.best[i];
  }
}

/// Each step is done for all points, because the steps of one point depend on each other.
template <typename Pack>
CREMED_ALWAYS_INLINE void evaluate(const MixtureComponents& components,
                                   std::span<const MixturePoint> points, MixtureScratch& scratch,
                                   std::span<MixtureResidual> residuals) {
  mixture_gate::list_blocks_of_points<Pack>(components, points, scratch);
  for (std::size_t i = 0; i < points.size(); ++i) {
    find_distances<Pack>(components, points[i], scratch.terms[i]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum_up<Pack>(scratch.terms[i], i, scratch.sums);
  }
  Tail tail;
  gather(components, points, scratch, tail);
  finish<Pack>(components.log_damped_size, tail);
  scatter(tail, scratch.sums, residuals);
}

void evaluate_plain(const MixtureComponents& components, std::span<const MixturePoint> points,
                    MixtureScratch& scratch, std::span<MixtureResidual> residuals) {
  evaluate<Pack<2>>(components, points, scratch, residuals);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void evaluate_avx2(const MixtureComponents& components,
                                           std::span<const MixturePoint> points,
                                           MixtureScratch& scratch,
                                           std::span<MixtureResidual> residuals) {
  evaluate<Pack<4>>(components, points, scratch, residuals);
}

[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw")]] void evaluate_avx512(
    const MixtureComponents& components, std::span<const MixturePoint> points,
    MixtureScratch& scratch, std::span<MixtureResidual> residuals) {
  evaluate<Pack<8>>(components, points, scratch, residuals);
}
#endif

}  // namespace

std::span<const NamedMixtureKernel> mixture_kernels() {
#ifdef __x86_64__
  static constexpr std::array<NamedMixtureKernel, 3> kKernels{
      {{"avx512", evaluate_avx512}, {"avx2", evaluate_avx2}, {"plain", evaluate_plain}}};
  __builtin_cpu_init();
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") != 0 &&
                          __builtin_cpu_supports("avx512dq") != 0 &&
                          __builtin_cpu_supports("avx512vl") != 0 &&
                          __builtin_cpu_supports("avx512bw") != 0;
  const std::span<const NamedMixtureKernel> all(kKernels);
  return all.subspan(has_avx512 ? 0 : has_avx2 ? 1 : 2);
#else
  static constexpr std::array<NamedMixtureKernel, 1> kKernels{{{"plain", evaluate_plain}}};
  return kKernels;
#endif
}

}  // namespace cremed
