// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/floor.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include <benchmark/benchmark.h>

#include "cremed/estimator/cost/mixture_kernel.hpp"
#include "cremed/estimator/cost/vector_math.hpp"

namespace cremed {
namespace {

using namespace vector_math;

/// Long enough to measure, short enough to be rarely interrupted.
constexpr int kPoints = 200;
constexpr int kRepetitions = 150;

template <typename Pack>
CREMED_ALWAYS_INLINE double sum_up(const MixtureComponents& components, const MixturePoint& point) {
  using Double = typename Pack::Double;
  const ComponentColumns<double>& c = components.exact;
  const Symmetric2& own = point.covariance_m2;
  std::array<Double, 1> sum{};
  for (std::size_t j = 0; j < components.size; j += Pack::kDoubles) {
    const Double ex = point.x_m - load<Double>(&c.x_m[j]);
    const Double ey = point.y_m - load<Double>(&c.y_m[j]);
    const Double cxx = own.xx + load<Double>(&c.xx[j]);
    const Double cxy = own.xy + load<Double>(&c.xy[j]);
    const Double cyy = own.yy + load<Double>(&c.yy[j]);
    const Double root = inverse_root<Pack>(cxx * cyy - cxy * cxy);
    const Double d = (ex * (cyy * ex - cxy * ey) + ey * (cxx * ey - cxy * ex)) * (root * root);
    sum[0] += load<Double>(&components.weight[j]) * root * exponential<Pack>(-0.5 * d);
  }
  return reduce(sum, Sum());
}

double sum_up_plain(const MixtureComponents& components, const MixturePoint& point) {
  return sum_up<Pack<2>>(components, point);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] double sum_up_avx2(const MixtureComponents& components,
                                           const MixturePoint& point) {
  return sum_up<Pack<4>>(components, point);
}

[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw")]] double sum_up_avx512(
    const MixtureComponents& components, const MixturePoint& point) {
  return sum_up<Pack<8>>(components, point);
}
#endif

using Floor = double (*)(const MixtureComponents&, const MixturePoint&);

Floor fastest_floor() {
#ifdef __x86_64__
  const std::string_view name = mixture_kernels().front().name;
  return name == "avx512" ? sum_up_avx512 : name == "avx2" ? sum_up_avx2 : sum_up_plain;
#else
  return sum_up_plain;
#endif
}

/// Components in a row, a metre apart.
void fill(MixtureComponents& components, std::size_t size) {
  components.size = size;
  for (std::size_t j = 0; j < MixtureComponents::kCapacity; ++j) {
    components.exact.x_m[j] = static_cast<double>(j);
    components.exact.xx[j] = 0.1;
    components.exact.yy[j] = 0.2;
    components.weight[j] = j < size ? 1.0 / static_cast<double>(size) : 0.0;
  }
}

}  // namespace

double floor_ns(std::size_t components) {
  const auto mixture = std::make_unique<MixtureComponents>();
  fill(*mixture, components);
  static const Floor kFloor = fastest_floor();
  double least_ns = 0.0;
  for (int k = 0; k < kRepetitions; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kPoints; ++i) {
      benchmark::DoNotOptimize(kFloor(*mixture, {0.1 * i, 0.5, {0.1, 0.01, 0.1}}));
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    least_ns = k == 0 ? taken.count() : std::min(least_ns, taken.count());
  }
  return least_ns / (kPoints * static_cast<double>(components));
}

}  // namespace cremed
