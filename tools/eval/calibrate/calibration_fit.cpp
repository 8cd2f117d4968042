// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/calibration_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <ceres/ceres.h>

#include "tools/eval/calibrate/calibration_residuals.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kNodeUs = 100'000;  // kNodeS
constexpr std::int64_t kGroupUs = 4'000'000;
constexpr double kTruthSpeedStdMps = 0.03;
constexpr double kTruthYawRateStdRadps = 0.005;
/// Prior of the motion: practically none.
constexpr double kPriorSpeedStdMps = 100.0;
constexpr double kPriorYawRateStdRadps = 10.0;
/// Least number of blocks of the jackknife: fewer have no useful variance.
constexpr double kMinBlocks = 5.0;
constexpr double kHuber = 3.0;
constexpr std::int64_t kSlopeNodes = 5;  // To both sides.
/// Factor on the standard deviation of the motion's change. Doppler measures lever arm times yaw
/// rate; a strong smoothness prior would reduce the turns and lengthen the lever arms (by 4 % with
/// a factor of 1 on simulated drives, less than 0.5 % with this one).
constexpr double kChangeFactor = 5.0;

/// A group of rows for the covariance: one block of time, or a prior.
struct Group {
  int rows;
  std::int64_t block;
};
constexpr std::int64_t kNoBlock = -1;

}  // namespace

/// The terms of one solve(). Ceres owns them.
struct CalibrationProblem {
  CalibrationFit& fit;
  ceres::Problem problem;
  std::vector<Group> groups;

  explicit CalibrationProblem(CalibrationFit& of) : fit(of) { add_measurements(); }

  void minimise();
  void add_measurements();
  void add_velocity(const VelocityMeasurement& measurement);
  void add_yaw_rate(const YawRateMeasurement& measurement);
  void add_changes();
  void add_truth();
  void add_priors();
  template <std::size_t N>
  void add_prior(const std::array<double, N>& prior, const std::array<double, N>& std,
                 std::array<double, N>& value) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorResidual<N>, N, N>(new PriorResidual<N>{prior, std}),
        nullptr, value.data());
    groups.push_back({static_cast<int>(N), kNoBlock});
  }
  [[nodiscard]] std::vector<double*> parameters();
  void set_std();

  void note(int rows, std::int64_t stamp_us) { groups.push_back({rows, stamp_us / kGroupUs}); }
};

void CalibrationProblem::add_measurements() {
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
}

void CalibrationProblem::add_velocity(const VelocityMeasurement& measurement) {
  const auto at = fit.place(measurement.radar, measurement.stamp_us, 0.0);
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<VelocityResidual, kDopplerStates, 3, 3,
                                                           kRollingStates, kCalibrationStates>(
                               new VelocityResidual{measurement.equations, at}),
                           new ceres::HuberLoss(kHuber), fit.nodes_[at.node].data(),
                           fit.nodes_[at.node + 1].data(), fit.vehicle_.value.data(),
                           fit.radars_[measurement.radar].value.data());
  note(kDopplerStates, measurement.stamp_us);
}

void CalibrationProblem::add_yaw_rate(const YawRateMeasurement& measurement) {
  FittedRadar& radar = fit.radars_[measurement.radar];
  const auto at = fit.place(measurement.radar, measurement.stamp_us, radar.value[kPositionLead]);
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<YawRateResidual, 1, 3, 3, kCalibrationStates>(
          new YawRateResidual{measurement, at}),
      new ceres::HuberLoss(1.0), fit.nodes_[at.node].data(), fit.nodes_[at.node + 1].data(),
      radar.value.data());
  note(1, measurement.stamp_us);
}

void CalibrationProblem::add_changes() {
  const MotionNode std = {kPriorSpeedStdMps, kPriorYawRateStdRadps,
                          fit.prior_.body_velocity_std_mps};
  for (auto& [number, node] : fit.nodes_) {
    add_prior<3>({}, std, node);
    if (const auto next = fit.nodes_.find(number + 1); next != fit.nodes_.end()) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ChangeResidual, 2, 3, 3>(
              new ChangeResidual{kChangeFactor * fit.prior_.acceleration_std_mps2 * kNodeS,
                                 kChangeFactor * fit.prior_.yaw_acceleration_std_radps2 * kNodeS}),
          nullptr, node.data(), next->second.data());
      groups.push_back({2, kNoBlock});
    }
  }
}

void CalibrationProblem::add_truth() {
  const double speed_std_mps = std::hypot(kTruthSpeedStdMps, fit.prior_.body_velocity_std_mps);
  const MotionNode std = {speed_std_mps, kTruthYawRateStdRadps, kTruthSpeedStdMps};
  for (auto& [number, node] : fit.nodes_) {
    const std::int64_t stamp_us = number * kNodeUs;
    if (const auto motion = fit.truth_->motion(stamp_us - kNodeUs, stamp_us + kNodeUs)) {
      const Eigen::Vector2d way =
          Eigen::Rotation2Dd(-0.5 * motion->z()) * Eigen::Vector2d(motion->head<2>());
      const MotionNode mean = {way.x() / (2 * kNodeS), motion->z() / (2 * kNodeS),
                               way.y() / (2 * kNodeS)};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TruthResidual, 3, 3, kRollingStates>(
                                   new TruthResidual{mean, std}),
                               nullptr, node.data(), fit.vehicle_.value.data());
      note(3, stamp_us);
    }
  }
}

void CalibrationProblem::add_priors() {
  add_prior(fit.vehicle_.prior, fit.vehicle_.prior_std, fit.vehicle_.value);
  for (FittedRadar& radar : fit.radars_) {
    add_prior(radar.prior, radar.prior_std, radar.value);
  }
  for (std::size_t i = 0; i < fit.yaw_std_rad_.size(); ++i) {
    FittedRadar& radar = fit.radars_[i];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<YawResidual, 1, kCalibrationStates>(
            new YawResidual{radar.prior[kYaw], std::max(fit.yaw_std_rad_[i], kHeldStd)}),
        new ceres::CauchyLoss(1.0), radar.value.data());
    groups.push_back({1, kNoBlock});
  }
}

/// Nodes first, radars and the vehicle last.
std::vector<double*> CalibrationProblem::parameters() {
  std::vector<double*> blocks;
  for (auto& [number, node] : fit.nodes_) {
    blocks.push_back(node.data());
  }
  for (FittedRadar& radar : fit.radars_) {
    blocks.push_back(radar.value.data());
  }
  blocks.push_back(fit.vehicle_.value.data());
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

/// Jackknife variances of the last `wanted` unknowns: each block is left out in turn, and the new
/// solution found by one Gauss-Newton step.
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
  const double count = std::max(static_cast<double>(blocks.size()), kMinBlocks);
  const double students_t = (count - 1.0) / (count - 3.0);
  return squares * ((count - 1.0) / count) * students_t;
}

/// Contribution of the priors, which belong to no block; `effects` are the covariances of the rows
/// with the wanted unknowns.
Eigen::VectorXd by_priors(const Eigen::MatrixXd& effects, const std::vector<Group>& groups) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(effects.cols());
  Eigen::Index row = 0;
  for (const Group& group : groups) {
    if (group.block == kNoBlock) {
      squares += effects.middleRows(row, group.rows).colwise().squaredNorm().transpose();
    }
    row += group.rows;
  }
  return squares;
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
  const auto wanted =
      static_cast<Eigen::Index>(fit.radars_.size() * kCalibrationStates + kRollingStates);
  const Factors factors(Eigen::SparseMatrix<double>(jacobian.transpose() * jacobian));
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(all, wanted);
  units.bottomRows(wanted).setIdentity();
  const Eigen::MatrixXd columns = factors.solve(units);
  const Eigen::Map<const Eigen::VectorXd> errors(residuals.data(), jacobian.rows());
  const Eigen::VectorXd variances =
      jackknife(jacobian, errors, groups, wanted) + by_priors(jacobian * columns, groups);
  const Eigen::VectorXd std = variances.cwiseSqrt();
  Eigen::Index at = 0;
  for (FittedRadar& radar : fit.radars_) {
    for (double& value : radar.std) {
      value = std[at++];
    }
  }
  for (double& value : fit.vehicle_.std) {
    value = std[at++];
  }
}

CalibrationFit::CalibrationFit(std::vector<FittedRadar> radars, const FittedVehicle& vehicle,
                               const MotionPrior& prior)
    : radars_(std::move(radars)), vehicle_(vehicle), prior_(prior) {}

void CalibrationFit::set_measurements(std::vector<VelocityMeasurement> velocities,
                                      std::vector<YawRateMeasurement> yaw_rates) {
  velocities_ = std::move(velocities);
  yaw_rates_ = std::move(yaw_rates);
}

MotionPlace CalibrationFit::place(std::size_t radar, std::int64_t stamp_us, double lead_s) const {
  const double shift_s = radars_[radar].value[kStamp] + lead_s;
  const std::int64_t shifted_us = stamp_us + std::llround(shift_s * 1e6);
  const std::int64_t node = shifted_us / kNodeUs;
  return {node, static_cast<double>(shifted_us - node * kNodeUs) / kNodeUs, shift_s, slope(node)};
}

/// By least squares over the neighbouring nodes.
MotionNode CalibrationFit::slope(std::int64_t number) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double count = 0.0;
  double first = 0.0;
  double second = 0.0;
  const auto end = nodes_.upper_bound(number + kSlopeNodes);
  for (auto node = nodes_.lower_bound(number - kSlopeNodes); node != end; ++node) {
    const auto t_s = static_cast<double>(node->first - number) * kNodeS;
    const Eigen::Vector3d motion(node->second.data());
    sum += motion;
    moment += t_s * motion;
    count += 1.0;
    first += t_s;
    second += t_s * t_s;
  }
  const double spread = count * second - first * first;
  if (count < 3.0) {
    return {};
  }
  const Eigen::Vector3d slope = (count * moment - first * sum) / spread;
  return {slope.x(), slope.y(), 0.0};
}

void CalibrationProblem::minimise() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::runtime_error("the calibration has no solution: " + summary.message);
  }
}

void CalibrationFit::solve() {
  CalibrationProblem problem(*this);
  problem.add_priors();
  problem.minimise();
  problem.set_std();
}

void CalibrationFit::minimise() {
  CalibrationProblem problem(*this);
  problem.add_priors();
  problem.minimise();
}

CalibrationFit CalibrationFit::part(std::size_t index, std::size_t count, bool is_inside) const {
  CalibrationFit result = *this;
  if (nodes_.empty()) {
    return result;
  }
  const std::int64_t begin = nodes_.begin()->first;
  const std::int64_t length = nodes_.rbegin()->first - begin + 1;
  const auto is_outside = [&](std::int64_t node) {
    const auto at = static_cast<std::size_t>(count * static_cast<std::size_t>(node - begin)) /
                    static_cast<std::size_t>(length);
    return (at == index) != is_inside;
  };
  std::erase_if(result.velocities_, [&](const VelocityMeasurement& measurement) {
    return is_outside(measurement.stamp_us / kNodeUs);
  });
  std::erase_if(result.yaw_rates_, [&](const YawRateMeasurement& measurement) {
    return is_outside(measurement.stamp_us / kNodeUs);
  });
  std::erase_if(result.nodes_, [&](const auto& node) { return is_outside(node.first); });
  return result;
}

double CalibrationFit::misfit(const std::vector<CalibrationVector>& values) const {
  CalibrationFit trial = *this;
  for (std::size_t radar = 0; radar < values.size(); ++radar) {
    trial.radars_[radar].value = values[radar];
  }
  CalibrationProblem problem(trial);
  problem.add_prior(trial.vehicle_.prior, trial.vehicle_.prior_std, trial.vehicle_.value);
  for (FittedRadar& radar : trial.radars_) {
    if (problem.problem.HasParameterBlock(radar.value.data())) {
      problem.problem.SetParameterBlockConstant(radar.value.data());
    }
  }
  problem.minimise();
  double cost = 0.0;
  problem.problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

std::optional<Eigen::Vector3d> CalibrationFit::motion(std::size_t radar, std::int64_t stamp_us,
                                                      double lead_s) const {
  const MotionPlace at = place(radar, stamp_us, lead_s);
  const auto before = nodes_.find(at.node);
  const auto after = nodes_.find(at.node + 1);
  if (before == nodes_.end() || after == nodes_.end()) {
    return std::nullopt;
  }
  const Eigen::Vector3d a(before->second.data());
  const Eigen::Vector3d b(after->second.data());
  return a + at.share * (b - a);
}

std::optional<DopplerState> CalibrationFit::expected(std::size_t radar,
                                                     std::int64_t stamp_us) const {
  const auto moving = motion(radar, stamp_us);
  if (!moving) {
    return std::nullopt;
  }
  return doppler_state(moving->data(), vehicle_.value.data(), radars_[radar].value.data());
}

}  // namespace cremed
