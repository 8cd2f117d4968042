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

/// `Width` doubles, or twice as many floats in the same space.
template <std::size_t Width>
struct Pack {
  static constexpr std::size_t kDoubles = Width;
  static constexpr std::size_t kFloats = 2 * Width;
  using Double __attribute__((vector_size(8 * Width))) = double;
  using Bits __attribute__((vector_size(8 * Width))) = std::uint64_t;
  using Index __attribute__((vector_size(8 * Width))) = std::int64_t;
  using Float __attribute__((vector_size(8 * Width))) = float;
  using FloatBits __attribute__((vector_size(8 * Width))) = std::int32_t;
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

/// Reduces all lanes of several vectors to one number. Lane k is combined with lane k + half first,
/// so that the order does not depend on the vector width.
template <typename Vector, std::size_t Count, typename Combine>
CREMED_ALWAYS_INLINE auto reduce(std::array<Vector, Count>& v, const Combine& combine) {
  for (std::size_t half = Count / 2; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) {
      v[k] = combine(v[k], v[k + half]);
    }
  }
  constexpr std::size_t kLanes = sizeof(Vector) / sizeof(v[0][0]);
  constexpr auto kAll = std::make_index_sequence<kLanes>();
  if constexpr (kLanes > 8) {
    v[0] = combine(v[0], rotate<8>(v[0], kAll));
  }
  if constexpr (kLanes > 4) {
    v[0] = combine(v[0], rotate<4>(v[0], kAll));
  }
  if constexpr (kLanes > 2) {
    v[0] = combine(v[0], rotate<2>(v[0], kAll));
  }
  v[0] = combine(v[0], rotate<1>(v[0], kAll));
  return v[0][0];
}

struct Sum {
  template <typename Vector>
  CREMED_ALWAYS_INLINE Vector operator()(const Vector& a, const Vector& b) const {
    return a + b;
  }
};

struct Least {
  template <typename Vector>
  CREMED_ALWAYS_INLINE Vector operator()(const Vector& a, const Vector& b) const {
    return b < a ? b : a;
  }
};

struct Greatest {
  template <typename Vector>
  CREMED_ALWAYS_INLINE Vector operator()(const Vector& a, const Vector& b) const {
    return b > a ? b : a;
  }
};

/// 1 / sqrt(x) of a positive normal number, to one or two units in the last place. Newton's method
/// from a start that is accurate to 3.4 % (Lomont 2003); faster than division and root.
template <typename Pack>
CREMED_ALWAYS_INLINE typename Pack::Double inverse_root(const typename Pack::Double& x) {
  using Bits = typename Pack::Bits;
  using Double = typename Pack::Double;
  const Double half = 0.5 * x;
  Double y = bit_cast<Double>(0x5fe6eb50c7b537a9U - (bit_cast<Bits>(x) >> 1U));
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  y = y * (1.5 - half * y * y);
  return y * (1.5 - half * y * y);
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

/// log(x) of a positive normal number, to one or two units in the last place; NaN for NaN and
/// infinity.
template <typename Pack>
CREMED_ALWAYS_INLINE typename Pack::Double logarithm(const typename Pack::Double& x) {
  using Bits = typename Pack::Bits;
  using Double = typename Pack::Double;
  constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcdU;
  constexpr std::uint64_t kBias = 1024;  // keeps the exponent positive
  // x = m 2^n with m in [sqrt(1/2), sqrt(2)).
  const Bits bits = bit_cast<Bits>(x);
  const Bits biased = (bits - kRootOfHalf + (kBias << 52U)) >> 52U;
  const Double m = bit_cast<Double>(bits - ((biased - kBias) << 52U));
  const Double n =
      bit_cast<Double>(biased | 0x4330000000000000U) - (0x1p52 + static_cast<double>(kBias));
  // log m = 2 artanh s; minimax polynomial of its series in s^2, relative error 2e-17.
  const Double s = (m - 1.0) / (m + 1.0);
  const Double z = s * s;
  const Double z2 = z * z;
  const Double p = (0.66666666666666697293 + 0.39999999999898273305 * z) +
                   z2 * ((0.28571428626533360281 + 0.22222211043819644872 * z) +
                         z2 * ((0.18182895746962094077 + 0.1533150171684712262 * z) +
                               z2 * 0.14619164822694796895));
  return (n * 0x1.62e42feep-1 + (2.0 * s + (s * z * p + n * 0x1.a39ef35793c76p-33))) + 0.0 * x;
}

}  // namespace cremed::vector_math
