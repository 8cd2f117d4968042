// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Max-Sum-Mixture residual of one point against a mixture, with its Jacobian.
/// Source: Pfeifer, Lange, Protzel, RA-L 2021, Max-Sum-Mixture.
struct MixtureResidual {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< (whitened error x, y; rest of the sum)
  Eigen::Matrix<double, 3, 2> jacobian = Eigen::Matrix<double, 3, 2>::Zero();  ///< d / d point
  double cost = 0.0;          ///< -log of the mixture at the point, up to a constant.
  std::size_t component = 0;  ///< The most likely component.
};

/// A point of the current scan, moved into the mixture's frame.
struct MixturePoint {
  double x_m = 0.0;
  double y_m = 0.0;
  Symmetric2 covariance_m2;
};

/// Means and covariances of the components, one column for each quantity. The capacity is a
/// multiple of the widest vector; the last vector is filled with components of weight 0.
template <typename Scalar>
struct ComponentColumns {
  static constexpr std::size_t kCapacity = kMaxDetections + kMaxRayComponents;
  using Column = std::array<Scalar, kCapacity>;

  alignas(64) Column x_m{};
  alignas(64) Column y_m{};
  alignas(64) Column xx{};
  alignas(64) Column xy{};
  alignas(64) Column yy{};
};

struct MixtureComponents {
  static constexpr std::size_t kCapacity = ComponentColumns<double>::kCapacity;
  static constexpr std::size_t kPadding = 16;  ///< Floats in the widest vector.
  static_assert(kCapacity % kPadding == 0);

  std::size_t size = 0;
  double log_damped_size = 0.0;  ///< log(size + damping)
  ComponentColumns<double> exact;
  alignas(64) ComponentColumns<double>::Column weight{};
  /// Single-precision copy for the gate.
  ComponentColumns<float> rough;
  alignas(64) ComponentColumns<float>::Column rough_offset{};  ///< -2 log weight + constant
  // Bounds of the rounding error of the rough distances.
  double max_eccentricity = 0.0;  ///< Greatest trace^2 / det of a covariance.
  double min_std_m = 0.0;         ///< Lower bound of any standard deviation.
  double max_coordinate_m = 0.0;  ///< Greatest coordinate.
};

/// Working space of a kernel.
struct MixtureScratch {
  /// Components in a block.
  static constexpr std::size_t kBlock = 8;
  /// Points evaluated together, which hides the latency of single operations.
  static constexpr std::size_t kBatch = 8;
  static constexpr std::size_t kMaxBlocks = MixtureComponents::kCapacity / kBlock;

  /// Terms of the components of a block, without the exponential.
  struct Block {
    using Lanes = std::array<double, kBlock>;
    alignas(64) Lanes squared_distance;  // e' C^-1 e
    alignas(64) Lanes scale;             // s
    alignas(64) Lanes gx;                // g = C^-1 e
    alignas(64) Lanes gy;
  };
  /// Of one point: indices of the blocks that are not negligible, and their terms.
  struct Terms {
    std::size_t block_count = 0;
    std::array<std::uint32_t, kMaxBlocks + 1> blocks{};
    double least_squared_distance = 0.0;
    std::array<Block, kMaxBlocks> of_block{};
  };
  /// Of all points: sums from which the residuals are computed.
  struct Sums {
    std::array<std::size_t, kBatch> best{};  // j* = argmax q
    std::array<double, kBatch> best_q{};     // q / exp(-1/2 least squared distance)
    std::array<double, kBatch> sum_q{};
    std::array<double, kBatch> sum_qgx{};
    std::array<double, kBatch> sum_qgy{};
  };

  alignas(64) std::array<ComponentColumns<float>::Column, kBatch> keys{};
  std::array<float, kBatch> least_key{};
  std::array<Terms, kBatch> terms{};
  Sums sums;
};

/// Residuals of 1 to MixtureScratch::kBatch points against at least one component.
using MixtureKernel = void (*)(const MixtureComponents& components,
                               std::span<const MixturePoint> points, MixtureScratch& scratch,
                               std::span<MixtureResidual> residuals);

/// A kernel compiled for an instruction set.
struct NamedMixtureKernel {
  std::string_view name;
  MixtureKernel kernel;
};

/// The kernels that this machine can run, the fastest first. All give bit-identical results.
std::span<const NamedMixtureKernel> mixture_kernels();

}  // namespace cremed
