// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/exponentiate.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "cremed/estimator/cost/vector_math.hpp"

namespace cremed {
namespace {

using namespace vector_math;

template <typename Pack>
CREMED_ALWAYS_INLINE void exponentiate_packs(std::span<double> numbers) {
  using Double = typename Pack::Double;
  std::size_t i = 0;
  for (; i + Pack::kDoubles <= numbers.size(); i += Pack::kDoubles) {
    store(&numbers[i], exponential<Pack>(load<Double>(&numbers[i])));
  }
  std::array<double, Pack::kDoubles> rest{};
  const auto end =
      std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(i), numbers.end(), rest.begin());
  store(rest.data(), exponential<Pack>(load<Double>(rest.data())));
  std::copy(rest.begin(), end, numbers.begin() + static_cast<std::ptrdiff_t>(i));
}

using Kernel = void (*)(std::span<double>);

void exponentiate_plain(std::span<double> numbers) { exponentiate_packs<Pack<2>>(numbers); }

#ifdef __x86_64__
[[gnu::target("avx2")]] void exponentiate_avx2(std::span<double> numbers) {
  exponentiate_packs<Pack<4>>(numbers);
}

Kernel fastest_kernel() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0 ? exponentiate_avx2 : exponentiate_plain;
}
#else
Kernel fastest_kernel() { return exponentiate_plain; }
#endif

}  // namespace

void exponentiate(std::span<double> numbers) {
  static const Kernel kKernel = fastest_kernel();
  kKernel(numbers);
}

}  // namespace cremed
