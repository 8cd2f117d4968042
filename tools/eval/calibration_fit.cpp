// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibration_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <ceres/ceres.h>

#include "tools/eval/calibration_residuals.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kNodeUs = 100'000;  // kNodeS
constexpr std::int64_t kBlockUs = 2'000'000;
constexpr double kTruthSpeedStdMps = 0.03;
constexpr double kTruthYawRateStdRadps = 0.005;
constexpr double kAnySpeedMps = 100.0;
constexpr double kAnyYawRateRadps = 10.0;
constexpr double kHuber = 3.0;

/// Rows that the covariance takes as one: those of one block of time, or a prior.
struct Group {
  int rows;
  std::int64_t block;
};
constexpr std::int64_t kNoBlock = -1;

}  // namespace

/// The terms of one solve(). Ceres owns what is added.
struct CalibrationProblem {
  CalibrationFit& fit;
  ceres::Problem problem;
  std::vector<Group> groups;

  explicit CalibrationProblem(CalibrationFit& of) : fit(of) { add_all(); }

  void add_all();
  void add_velocity(const VelocityMeasurement& measurement);
  void add_yaw_rate(const YawRateMeasurement& measurement);
  void add_changes();
  void add_truth();
  void add_priors();
  [[nodiscard]] std::vector<double*> parameters();
  void set_std();

  void note(int rows, std::int64_t stamp_us) { groups.push_back({rows, stamp_us / kBlockUs}); }
};

void CalibrationProblem::add_all() {
  for (const VelocityMeasurement& measurement : fit.velocities_) {
    add_velocity(measurement);
  }
  for (const YawRateMeasurement& measurement : fit.yaw_rates_) {
    add_yaw_rate(measurement);
  }
  add_changes();
  if (fit.truth_ != nullptr) {
    add_truth();
  }
  add_priors();
}

void CalibrationProblem::add_velocity(const VelocityMeasurement& measurement) {
  const auto at = fit.place(measurement.radar, measurement.stamp_us);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<VelocityResidual, 4, 2, 2, kCalibrationStates>(
          new VelocityResidual{measurement.equations, at.share_without_offset}),
      new ceres::HuberLoss(kHuber), fit.nodes_[at.node].data(), fit.nodes_[at.node + 1].data(),
      fit.radars_[measurement.radar].value.data());
  note(4, measurement.stamp_us);
}

void CalibrationProblem::add_yaw_rate(const YawRateMeasurement& measurement) {
  const auto at = fit.place(measurement.radar, measurement.stamp_us);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<YawRateResidual, 1, 2, 2, kCalibrationStates>(
          new YawRateResidual{measurement, at.share_without_offset}),
      new ceres::HuberLoss(1.0), fit.nodes_[at.node].data(), fit.nodes_[at.node + 1].data(),
      fit.radars_[measurement.radar].value.data());
  note(1, measurement.stamp_us);
}

/// Next to nothing is known of nodes without a measurement, when the vehicle stands.
void CalibrationProblem::add_changes() {
  for (auto& [number, node] : fit.nodes_) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<NodeResidual, 2, 2>(
                                 new NodeResidual{0.0, 0.0, kAnySpeedMps, kAnyYawRateRadps}),
                             nullptr, node.data());
    groups.push_back({2, kNoBlock});
    if (const auto next = fit.nodes_.find(number + 1); next != fit.nodes_.end()) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ChangeResidual, 2, 2, 2>(
              new ChangeResidual{fit.prior_.acceleration_std_mps2 * kNodeS,
                                 fit.prior_.yaw_acceleration_std_radps2 * kNodeS}),
          nullptr, node.data(), next->second.data());
      groups.push_back({2, kNoBlock});
    }
  }
}

void CalibrationProblem::add_truth() {
  for (auto& [number, node] : fit.nodes_) {
    const std::int64_t stamp_us = number * kNodeUs;
    if (const auto motion = fit.truth_->motion(stamp_us - kNodeUs, stamp_us + kNodeUs)) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<NodeResidual, 2, 2>(new NodeResidual{
                                   motion->x() / (2 * kNodeS), motion->z() / (2 * kNodeS),
                                   kTruthSpeedStdMps, kTruthYawRateStdRadps}),
                               nullptr, node.data());
      note(2, stamp_us);
    }
  }
}

void CalibrationProblem::add_priors() {
  for (FittedRadar& radar : fit.radars_) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorResidual, kCalibrationStates, kCalibrationStates>(
            new PriorResidual{radar.prior, radar.prior_std}),
        nullptr, radar.value.data());
    groups.push_back({kCalibrationStates, kNoBlock});
  }
}

/// Nodes first, radars last.
std::vector<double*> CalibrationProblem::parameters() {
  std::vector<double*> blocks;
  for (auto& [number, node] : fit.nodes_) {
    blocks.push_back(node.data());
  }
  for (FittedRadar& radar : fit.radars_) {
    blocks.push_back(radar.value.data());
  }
  return blocks;
}

namespace {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Factors = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// Rows of each block of time: the Jacobian with all others zero.
std::map<std::int64_t, RowMatrix> blocks_of(const RowMatrix& jacobian,
                                            const std::vector<Group>& groups) {
  std::map<std::int64_t, std::vector<Eigen::Triplet<double>>> entries;
  int row = 0;
  for (const Group& group : groups) {
    for (int i = 0; i < group.rows; ++i, ++row) {
      for (RowMatrix::InnerIterator at(jacobian, row); group.block != kNoBlock && at; ++at) {
        entries[group.block].emplace_back(row, static_cast<int>(at.col()), at.value());
      }
    }
  }
  std::map<std::int64_t, RowMatrix> blocks;
  for (const auto& [block, triplets] : entries) {
    RowMatrix& rows = blocks.try_emplace(block, jacobian.rows(), jacobian.cols()).first->second;
    rows.setFromTriplets(triplets.begin(), triplets.end());
  }
  return blocks;
}

/// Variances of the last `wanted` unknowns by leaving out one block after the other; each new
/// solution is one Gauss-Newton step away.
Eigen::VectorXd jackknife(const RowMatrix& jacobian, const Eigen::VectorXd& residuals,
                          const std::vector<Group>& groups, Eigen::Index wanted) {
  const Eigen::SparseMatrix<double> information = jacobian.transpose() * jacobian;
  const auto blocks = blocks_of(jacobian, groups);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(wanted);
  for (const auto& [block, rows] : blocks) {
    const Eigen::SparseMatrix<double> own = rows.transpose() * rows;
    const Factors rest(information - own);
    const Eigen::VectorXd gradient = rows.transpose() * residuals;
    const Eigen::VectorXd step = rest.solve(gradient);
    squares += step.tail(wanted).cwiseAbs2();
  }
  const auto count = static_cast<double>(blocks.size());
  return squares * ((count - 1.0) / count);
}

Eigen::SparseMatrix<double, Eigen::RowMajor> to_eigen(ceres::CRSMatrix& matrix) {
  return Eigen::Map<Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      matrix.num_rows, matrix.num_cols, static_cast<Eigen::Index>(matrix.values.size()),
      matrix.rows.data(), matrix.cols.data(), matrix.values.data());
}

}  // namespace

void CalibrationProblem::set_std() {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = parameters();
  problem.GetResidualBlocks(&options.residual_blocks);
  std::vector<double> residuals;
  ceres::CRSMatrix crs;
  problem.Evaluate(options, nullptr, &residuals, nullptr, &crs);
  const auto jacobian = to_eigen(crs);

  const Eigen::Index all = jacobian.cols();
  const auto wanted = static_cast<Eigen::Index>(fit.radars_.size() * kCalibrationStates);
  const Factors factors(Eigen::SparseMatrix<double>(jacobian.transpose() * jacobian));
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(all, wanted);
  units.bottomRows(wanted).setIdentity();
  const Eigen::MatrixXd columns = factors.solve(units);
  const Eigen::VectorXd by_model = columns.bottomRows(wanted).diagonal();
  const Eigen::VectorXd by_blocks = jackknife(
      jacobian, Eigen::Map<Eigen::VectorXd>(residuals.data(), jacobian.rows()), groups, wanted);
  for (Eigen::Index i = 0; i < wanted; ++i) {
    const auto at = static_cast<std::size_t>(i);
    fit.radars_[at / kCalibrationStates].std[at % kCalibrationStates] =
        std::sqrt(std::max(by_model[i], by_blocks[i]));
  }
}

CalibrationFit::CalibrationFit(std::vector<FittedRadar> radars, const MotionPrior& prior)
    : radars_(std::move(radars)), prior_(prior) {}

void CalibrationFit::set_measurements(std::vector<VelocityMeasurement> velocities,
                                      std::vector<YawRateMeasurement> yaw_rates) {
  velocities_ = std::move(velocities);
  yaw_rates_ = std::move(yaw_rates);
}

CalibrationFit::Place CalibrationFit::place(std::size_t radar, std::int64_t stamp_us) const {
  const auto shift_us = std::llround(radars_[radar].value[kStamp] * 1e6);
  const std::int64_t node = (stamp_us + shift_us) / kNodeUs;
  return {node, static_cast<double>(stamp_us - node * kNodeUs) / kNodeUs};
}

void CalibrationFit::solve() {
  CalibrationProblem problem(*this);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::runtime_error("the calibration has no solution: " + summary.message);
  }
  problem.set_std();
}

std::optional<Eigen::Vector2d> CalibrationFit::motion(std::size_t radar,
                                                      std::int64_t stamp_us) const {
  const Place at = place(radar, stamp_us);
  const auto before = nodes_.find(at.node);
  const auto after = nodes_.find(at.node + 1);
  if (before == nodes_.end() || after == nodes_.end()) {
    return std::nullopt;
  }
  const double share = at.share_without_offset + radars_[radar].value[kStamp] / kNodeS;
  const Eigen::Vector2d a(before->second.data());
  const Eigen::Vector2d b(after->second.data());
  return a + share * (b - a);
}

std::optional<DopplerState> CalibrationFit::expected(std::size_t radar,
                                                     std::int64_t stamp_us) const {
  const auto vehicle = motion(radar, stamp_us);
  if (!vehicle) {
    return std::nullopt;
  }
  return doppler_state(vehicle->x(), vehicle->y(), radars_[radar].value.data());
}

}  // namespace cremed
