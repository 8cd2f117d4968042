// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

/// Vector arithmetic with GCC's vector extensions, for any instruction set: functions are inlined
/// into callers that are compiled for one (attribute target). All operations are rounded as IEEE
/// 754 defines, so results are bit-identical on every machine if the file is compiled with
/// -ffp-contract=off.
namespace cremed::vector_math {

#define CREMED_ALWAYS_INLINE [[gnu::always_inline]] inline

/// `Width` doubles.
template <std::size_t Width>
struct Pack {
  static constexpr std::size_t kDoubles = Width;
  using Double __attribute__((vector_size(8 * Width))) = double;
  using Bits __attribute__((vector_size(8 * Width))) = std::uint64_t;
};

template <typename Vector, typename Scalar>
CREMED_ALWAYS_INLINE Vector load(const Scalar* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}

template <typename Vector, typename Scalar>
CREMED_ALWAYS_INLINE void store(Scalar* to, const Vector& vector) {
  std::memcpy(to, &vector, sizeof vector);
}

template <typename To, typename From>
CREMED_ALWAYS_INLINE To bit_cast(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

template <std::size_t Step, typename Vector, std::size_t... Lane>
CREMED_ALWAYS_INLINE Vector rotate(const Vector& v, std::index_sequence<Lane...> /*lanes*/) {
  return __builtin_shufflevector(v, v, static_cast<int>((Lane + Step) % sizeof...(Lane))...);
}

/// Sum of all lanes of several vectors. Lane k is added to lane k + half first, so that the order
/// does not depend on the vector width.
template <typename Vector, std::size_t Count>
CREMED_ALWAYS_INLINE double sum(std::array<Vector, Count>& v) {
  for (std::size_t half = Count / 2; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      v[k] += v[k + half];
    }
  }
  constexpr std::size_t kLanes = sizeof(Vector) / sizeof(double);
  constexpr auto kAll = std::make_index_sequence<kLanes>();
  if constexpr (kLanes > 2) {
    v[0] += rotate<2>(v[0], kAll);
  }
  v[0] += rotate<1>(v[0], kAll);
  return v[0][0];
}

/// exp(x) of x <= 0, to a few units in the last place; exp(-600) below -600.
template <typename Pack>
CREMED_ALWAYS_INLINE typename Pack::Double exponential(const typename Pack::Double& x) {
  using Bits = typename Pack::Bits;
  using Double = typename Pack::Double;
  constexpr double kRound = 0x1.8p52;  // after adding it, the last bits hold the rounded integer
  const Double low = Double{} - 600.0;
  const Double t = low > x ? low : x;
  const Double shifted = t * 1.4426950408889634 + kRound;
  const Double n = shifted - kRound;
  const Double r = (t - n * 0x1.62e42feep-1) - n * 0x1.a39ef35793c76p-33;  // t - n log 2
  // Minimax polynomial of degree 10 on |r| <= log(2) / 2, error 2e-16.
  const Double r2 = r * r;
  const Double r4 = r2 * r2;
  const Double a = (1.0 + 1.0000000000000068101 * r) +
                   r2 * (0.50000000000000056734 + 0.16666666666553502753 * r);
  const Double b = (0.041666666666572391458 + 0.0083333333859827838024 * r) +
                   r2 * (0.001388888893275100025 + 0.00019841169871202734661 * r);
  const Double c =
      (0.000024801504014426905068 + 2.7640346826138499161e-6 * r) + r2 * 2.7626495546432196255e-7;
  const Double y = a + r4 * (b + r4 * c);
  return bit_cast<Double>(bit_cast<Bits>(y) + (bit_cast<Bits>(shifted) << 52U));
}

}  // namespace cremed::vector_math
