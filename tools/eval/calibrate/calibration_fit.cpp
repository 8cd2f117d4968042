// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/calibration_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "tools/eval/calibrate/calibration_residuals.hpp"
#include "tools/eval/calibrate/least_squares.hpp"

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

constexpr std::int64_t kNoBlock = -1;  // Of a prior.

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Factors = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// Rows of each block of time: the Jacobian with all others zero.
std::map<std::int64_t, RowMatrix> parts_of(const RowMatrix& jacobian,
                                           const std::vector<std::int64_t>& blocks) {
  std::map<std::int64_t, std::vector<Eigen::Triplet<double>>> entries;
  for (int row = 0; row < jacobian.rows(); ++row) {
    const std::int64_t block = blocks[static_cast<std::size_t>(row)];
    for (RowMatrix::InnerIterator at(jacobian, row); block != kNoBlock && at; ++at) {
      entries[block].emplace_back(row, static_cast<int>(at.col()), at.value());
    }
  }
  std::map<std::int64_t, RowMatrix> parts;
  for (const auto& [block, triplets] : entries) {
    RowMatrix& rows = parts.try_emplace(block, jacobian.rows(), jacobian.cols()).first->second;
    rows.setFromTriplets(triplets.begin(), triplets.end());
  }
  return parts;
}

/// Jackknife variances of the last `wanted` unknowns: each block is left out in turn, and the new
/// solution found by one Gauss-Newton step.
Eigen::VectorXd jackknife(const RowMatrix& jacobian, const Eigen::VectorXd& residuals,
                          const std::vector<std::int64_t>& blocks, Eigen::Index wanted) {
  const Eigen::SparseMatrix<double> information = jacobian.transpose() * jacobian;
  const auto parts = parts_of(jacobian, blocks);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(wanted);
  Factors rest;
  rest.analyzePattern(information);  // Every rest has this pattern, with zeros in it.
  for (const auto& [block, rows] : parts) {
    const Eigen::SparseMatrix<double> own = rows.transpose() * rows;
    rest.factorize(information - own);
    const Eigen::VectorXd gradient = rows.transpose() * residuals;
    const Eigen::VectorXd step = rest.solve(gradient);
    squares += step.tail(wanted).cwiseAbs2();
  }
  const double count = std::max(static_cast<double>(parts.size()), kMinBlocks);
  const double students_t = (count - 1.0) / (count - 3.0);
  return squares * ((count - 1.0) / count) * students_t;
}

/// Contribution of the priors, which belong to no block; `effects` are the covariances of the rows
/// with the wanted unknowns.
Eigen::VectorXd by_priors(const Eigen::MatrixXd& effects, const std::vector<std::int64_t>& blocks) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(effects.cols());
  for (std::size_t row = 0; row < blocks.size(); ++row) {
    if (blocks[row] == kNoBlock) {
      squares += effects.row(static_cast<Eigen::Index>(row)).cwiseAbs2().transpose();
    }
  }
  return squares;
}

}  // namespace

/// The terms of one solve().
struct CalibrationProblem {
  CalibrationFit& fit;
  LeastSquares squares;
  std::vector<std::int64_t> blocks;  // Of time, for the covariance: of each row.

  explicit CalibrationProblem(CalibrationFit& of) : fit(of) { add_all(); }

  /// Nodes first, radars and the vehicle last.
  void add_unknowns() {
    for (const VelocityMeasurement& measurement : fit.velocities_) {
      fit.make_nodes(fit.place(measurement.radar, measurement.stamp_us, 0.0));
    }
    for (const YawRateMeasurement& measurement : fit.yaw_rates_) {
      const double lead_s = fit.radars_[measurement.radar].value[kPositionLead];
      fit.make_nodes(fit.place(measurement.radar, measurement.stamp_us, lead_s));
    }
    for (auto& [number, node] : fit.nodes_) {
      squares.add_unknowns(node);
    }
    for (FittedRadar& radar : fit.radars_) {
      squares.add_unknowns(radar.value);
    }
    squares.add_unknowns(fit.vehicle_.value);
  }

  void add_all() {
    add_unknowns();
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

  void add_velocity(const VelocityMeasurement& measurement) {
    const auto at = fit.place(measurement.radar, measurement.stamp_us, 0.0);
    squares.add<kDopplerStates>(VelocityResidual{measurement.equations, at},
                                Loss{Loss::Kind::huber, kHuber}, fit.nodes_.at(at.node),
                                fit.nodes_.at(at.node + 1), fit.vehicle_.value,
                                fit.radars_[measurement.radar].value);
    note(kDopplerStates, measurement.stamp_us);
  }

  void add_yaw_rate(const YawRateMeasurement& measurement) {
    FittedRadar& radar = fit.radars_[measurement.radar];
    const auto at = fit.place(measurement.radar, measurement.stamp_us, radar.value[kPositionLead]);
    squares.add<1>(YawRateResidual{measurement, at}, Loss{Loss::Kind::huber, 1.0},
                   fit.nodes_.at(at.node), fit.nodes_.at(at.node + 1), radar.value);
    note(1, measurement.stamp_us);
  }

  void add_changes() {
    const MotionNode std = {kPriorSpeedStdMps, kPriorYawRateStdRadps,
                            fit.prior_.body_velocity_std_mps};
    for (auto& [number, node] : fit.nodes_) {
      add_prior<3>({}, std, node);
      if (const auto next = fit.nodes_.find(number + 1); next != fit.nodes_.end()) {
        squares.add<2>(
            ChangeResidual{kChangeFactor * fit.prior_.acceleration_std_mps2 * kNodeS,
                           kChangeFactor * fit.prior_.yaw_acceleration_std_radps2 * kNodeS},
            Loss{}, node, next->second);
        note_prior(2);
      }
    }
  }

  void add_truth() {
    const double speed_std_mps = std::hypot(kTruthSpeedStdMps, fit.prior_.body_velocity_std_mps);
    const MotionNode std = {speed_std_mps, kTruthYawRateStdRadps, kTruthSpeedStdMps};
    for (auto& [number, node] : fit.nodes_) {
      const std::int64_t stamp_us = number * kNodeUs;
      if (const auto motion = fit.truth_->motion(stamp_us - kNodeUs, stamp_us + kNodeUs)) {
        const Eigen::Vector2d way =
            Eigen::Rotation2Dd(-0.5 * motion->z()) * Eigen::Vector2d(motion->head<2>());
        const MotionNode mean = {way.x() / (2 * kNodeS), motion->z() / (2 * kNodeS),
                                 way.y() / (2 * kNodeS)};
        squares.add<3>(TruthResidual{mean, std}, Loss{}, node, fit.vehicle_.value);
        note(3, stamp_us);
      }
    }
  }

  void add_priors() {
    add_prior(fit.vehicle_.prior, fit.vehicle_.prior_std, fit.vehicle_.value);
    for (FittedRadar& radar : fit.radars_) {
      add_prior(radar.prior, radar.prior_std, radar.value);
    }
    for (std::size_t i = 0; i < fit.yaw_std_rad_.size(); ++i) {
      FittedRadar& radar = fit.radars_[i];
      squares.add<1>(YawResidual{radar.prior[kYaw], std::max(fit.yaw_std_rad_[i], kHeldStd)},
                     Loss{Loss::Kind::cauchy, 1.0}, radar.value);
      note_prior(1);
    }
  }

  template <std::size_t N>
  void add_prior(const std::array<double, N>& prior, const std::array<double, N>& std,
                 std::array<double, N>& value) {
    squares.add<static_cast<int>(N)>(PriorResidual<N>{prior, std}, Loss{}, value);
    note_prior(N);
  }

  void set_std() {
    const auto [jacobian, errors, cost] = squares.linearise();
    const Eigen::Index all = jacobian.cols();
    const auto wanted =
        static_cast<Eigen::Index>(fit.radars_.size() * kCalibrationStates + kRollingStates);
    const Factors factors(Eigen::SparseMatrix<double>(jacobian.transpose() * jacobian));
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(all, wanted);
    units.bottomRows(wanted).setIdentity();
    const Eigen::MatrixXd columns = factors.solve(units);
    const Eigen::VectorXd variances =
        jackknife(jacobian, errors, blocks, wanted) + by_priors(jacobian * columns, blocks);
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

  void note(std::size_t rows, std::int64_t stamp_us) {
    blocks.insert(blocks.end(), rows, stamp_us / kGroupUs);
  }
  void note_prior(std::size_t rows) { blocks.insert(blocks.end(), rows, kNoBlock); }
};

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

void CalibrationFit::make_nodes(const MotionPlace& at) {
  nodes_.try_emplace(at.node);
  nodes_.try_emplace(at.node + 1);
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

void CalibrationFit::solve() {
  CalibrationProblem problem(*this);
  problem.squares.solve();
  problem.set_std();
}

void CalibrationFit::minimise() { CalibrationProblem(*this).squares.solve(); }

CalibrationFit CalibrationFit::part(std::size_t index, std::size_t count, bool is_inside) const {
  CalibrationFit result = *this;
  if (nodes_.empty()) {
    return result;
  }
  // Of the time that was measured: of a stop, or between two logs, there are no nodes.
  std::vector<std::int64_t> numbers;
  for (const auto& [number, node] : nodes_) {
    numbers.push_back(number);
  }
  const auto is_outside = [&](std::int64_t node) {
    const auto rank = std::ranges::lower_bound(numbers, node) - numbers.begin();
    return (count * static_cast<std::size_t>(rank) / numbers.size() == index) != is_inside;
  };
  const auto is_measured_outside = [&](const auto& measurement) {
    return is_outside(measurement.stamp_us / kNodeUs);
  };
  std::erase_if(result.velocities_, is_measured_outside);
  std::erase_if(result.yaw_rates_, is_measured_outside);
  std::erase_if(result.nodes_, [&](const auto& node) { return is_outside(node.first); });
  return result;
}

double CalibrationFit::misfit(const std::vector<CalibrationVector>& values,
                              const std::optional<double>& slip) const {
  CalibrationFit trial = *this;
  trial.yaw_std_rad_.clear();
  for (std::size_t radar = 0; radar < values.size(); ++radar) {
    trial.radars_[radar].prior = trial.radars_[radar].value = values[radar];
    trial.radars_[radar].prior_std = {};
  }
  if (slip) {
    trial.vehicle_.prior[kSlip] = trial.vehicle_.value[kSlip] = *slip;
    trial.vehicle_.prior_std[kSlip] = 0.0;
  }
  CalibrationProblem problem(trial);
  problem.squares.solve();
  return problem.squares.linearise().cost;
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
