// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cremed/estimator/cost/mixture_kernel.hpp"
#include "cremed/estimator/cost/vector_math.hpp"

/// First step of a mixture kernel: finds the components that are not negligible for a point, in
/// single precision.
namespace cremed::mixture_gate {

using vector_math::bit_cast;
using vector_math::Least;
using vector_math::load;
using vector_math::reduce;
using vector_math::store;

inline constexpr std::size_t kBlock = MixtureScratch::kBlock;
inline constexpr std::size_t kPadding = MixtureComponents::kPadding;
static_assert(kPadding == 2 * kBlock);

/// A component is negligible if its q is less than 1e-11 of the greatest: 2 log(1e11).
inline constexpr double kNegligible = 50.7;

/// Up to this many blocks, evaluating all of them is faster than the gate.
inline constexpr std::size_t kMaxUngatedBlocks = 4;

/// Keys of all components, -2 log q up to a constant in single precision, and the smallest key. The
/// logarithm of det is read from its bits (exponent, linear in between), at most 0.06 too low.
template <typename Pack>
CREMED_ALWAYS_INLINE void find_keys(const MixtureComponents& components, const MixturePoint& point,
                                    ComponentColumns<float>::Column& keys, float& least_key) {
  using Float = typename Pack::Float;
  constexpr float kLogPerBit = 0x1.62e43p-24F;  // log(2) / 2^23
  const ComponentColumns<float>& c = components.rough;
  const Symmetric2& own = point.covariance_m2;
  const auto x = static_cast<float>(point.x_m);
  const auto y = static_cast<float>(point.y_m);
  const auto xx = static_cast<float>(own.xx);
  const auto xy = static_cast<float>(own.xy);
  const auto yy = static_cast<float>(own.yy);
  std::array<Float, kPadding / Pack::kFloats> low;
  for (std::size_t part = 0; part < low.size(); ++part) {
    Float part_low = Float{} + std::numeric_limits<float>::infinity();
    for (std::size_t j = part * Pack::kFloats; j < components.size; j += kPadding) {
      const Float ex = x - load<Float>(&c.x_m[j]);
      const Float ey = y - load<Float>(&c.y_m[j]);
      const Float cxx = xx + load<Float>(&c.xx[j]);
      const Float cxy = xy + load<Float>(&c.xy[j]);
      const Float cyy = yy + load<Float>(&c.yy[j]);
      const Float det = cxx * cyy - cxy * cxy;
      const Float d = (ex * (cyy * ex - cxy * ey) + ey * (cxx * ey - cxy * ex)) / det;
      const Float bits = __builtin_convertvector(bit_cast<typename Pack::FloatBits>(det), Float);
      const Float key = d + (bits * kLogPerBit + load<Float>(&components.rough_offset[j]));
      store(&keys[j], key);
      part_low = key < part_low ? key : part_low;
    }
    low[part] = part_low;
  }
  least_key = reduce(low, Least());
}

/// Upper bound of the keys of components that are not negligible, with the rounding of single
/// precision: that of a squared distance grows with the eccentricity of the covariances, and with
/// the size of coordinates in standard deviations. Infinite, so that all blocks are listed, if it
/// can be more than 2 %.
CREMED_ALWAYS_INLINE float greatest_key(const MixtureComponents& components,
                                        const MixturePoint& point, float least_key) {
  constexpr double kUnit = 0x1p-24;               // rounding of a float
  constexpr double kLogError = 0.07;              // of log det
  constexpr double kMaxDistanceMinusKey = 200.0;  // a squared distance exceeds its key by less
  const Symmetric2& own = point.covariance_m2;
  const double trace = own.xx + own.yy;
  const double det = own.xx * own.yy - own.xy * own.xy;
  const double own_eccentricity = trace * trace / det;
  const double eccentricity = components.max_eccentricity > own_eccentricity
                                  ? components.max_eccentricity
                                  : own_eccentricity;
  const double max_coordinate_m =
      components.max_coordinate_m + std::abs(point.x_m) + std::abs(point.y_m);
  const double error =
      kUnit * (16.0 * eccentricity + 4.0 * max_coordinate_m / components.min_std_m);
  if (!(error < 0.02)) {
    return std::numeric_limits<float>::infinity();
  }
  const auto key = static_cast<double>(least_key);
  return static_cast<float>(key + kNegligible + kLogError +
                            2.0 * error * (key + kMaxDistanceMinusKey));
}

/// `found` is not 0 for each of the two blocks of 16 keys that has a key not greater than `key`.
template <typename Pack>
CREMED_ALWAYS_INLINE void find_not_greater(const float* keys, float key,
                                           std::array<std::uint64_t, 2>& found) {
  using Float = typename Pack::Float;
  if constexpr (Pack::kFloats == kPadding) {
    using Bytes __attribute__((vector_size(kPadding))) = std::int8_t;
    const typename Pack::FloatBits is_kept = load<Float>(keys) <= key;
    store(found.data(), __builtin_convertvector(is_kept, Bytes));
  } else {
    alignas(64) std::array<std::uint64_t, kPadding / 2> is_kept;
    for (std::size_t j = 0; j < kPadding; j += Pack::kFloats) {
      store(&is_kept[j / 2], load<Float>(keys + j) <= key);
    }
    found[0] = (is_kept[0] | is_kept[1]) | (is_kept[2] | is_kept[3]);
    found[1] = (is_kept[4] | is_kept[5]) | (is_kept[6] | is_kept[7]);
  }
}

/// Lists the blocks that have a key not greater than `key`. Branch-free, because branches would be
/// unpredictable.
template <typename Pack>
CREMED_ALWAYS_INLINE void list_blocks(std::size_t size, float key,
                                      const ComponentColumns<float>::Column& keys,
                                      MixtureScratch::Terms& terms) {
  std::array<std::uint64_t, 2> found;
  std::size_t count = 0;
  for (std::size_t j = 0; j < size; j += kPadding) {
    find_not_greater<Pack>(&keys[j], key, found);
    terms.blocks[count] = static_cast<std::uint32_t>(j / kBlock);
    count += found[0] != 0 ? 1U : 0U;
    terms.blocks[count] = static_cast<std::uint32_t>(j / kBlock + 1);
    count += found[1] != 0 ? 1U : 0U;
  }
  terms.block_count = count;
}

CREMED_ALWAYS_INLINE void list_all_blocks(std::size_t size, MixtureScratch::Terms& terms) {
  terms.block_count = (size + kBlock - 1) / kBlock;
  for (std::size_t block = 0; block < terms.block_count; ++block) {
    terms.blocks[block] = static_cast<std::uint32_t>(block);
  }
}

/// Lists the blocks that are not negligible for each point.
template <typename Pack>
CREMED_ALWAYS_INLINE void list_blocks_of_points(const MixtureComponents& components,
                                                std::span<const MixturePoint> points,
                                                MixtureScratch& scratch) {
  const std::size_t size = components.size;
  if (size <= kMaxUngatedBlocks * kBlock) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      list_all_blocks(size, scratch.terms[i]);
    }
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    find_keys<Pack>(components, points[i], scratch.keys[i], scratch.least_key[i]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float key = greatest_key(components, points[i], scratch.least_key[i]);
    list_blocks<Pack>(size, key, scratch.keys[i], scratch.terms[i]);
  }
}

}  // namespace cremed::mixture_gate
