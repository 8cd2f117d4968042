// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/scan/target_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cremed/estimator/scan/rotation_lead.hpp"

namespace cremed {
namespace {

/// Counts the detection as used or under the reason it is left out; true if it is used.
bool is_selected(const Detection& detection, const DetectionLimits& limits,
                 SelectionCounters& counters) {
  switch (detection.validity) {
    case Validity::usable:
      break;
    case Validity::no_noise:
      ++counters.no_noise;
      return false;
    case Validity::invalid_state:
      ++counters.invalid_state;
      return false;
    case Validity::moving:
      ++counters.moving;
      return false;
    case Validity::low_existence:
      ++counters.low_existence;
      return false;
    case Validity::no_position:
    case Validity::empty:
      ++counters.no_position;
      return false;
  }
  // NaN passes these comparisons, so that the estimator's own check sees it.
  if (detection.range_m < limits.min_range_m || detection.range_m > limits.max_range_m ||
      std::abs(detection.azimuth_rad) > limits.max_abs_azimuth_rad ||
      detection.rcs_dbm2 < limits.min_rcs_dbm2) {
    ++counters.outside_limits;
    return false;
  }
  ++counters.used;
  return true;
}

/// Rounding can make det(C) of a singular C as large as this, relative to xx yy.
constexpr double kMinRelativeDeterminant = 1e-12;

bool is_finite_target(const Target& t) {
  const Symmetric2& c = t.covariance_m2;
  const double determinant = c.determinant();
  return std::isfinite(t.x_m) && std::isfinite(t.y_m) && std::isfinite(t.bearing_rad) &&
         std::isfinite(t.doppler_mps) && std::isfinite(t.bearing_std_rad) &&
         std::isfinite(t.doppler_std_mps) && std::isfinite(determinant) &&
         t.bearing_std_rad > 0.0 && t.doppler_std_mps > 0.0 &&
         determinant > kMinRelativeDeterminant * c.xx * c.yy;
}

}  // namespace

double azimuth_rad(const Target& target, const Pose2& vehicle_from_radar) {
  const double rad = target.bearing_rad - vehicle_from_radar.yaw_rad;
  // The library's remainder takes 7 % of a calibration's time.
  return std::abs(rad) <= std::numbers::pi ? rad : std::remainder(rad, 2.0 * std::numbers::pi);
}

Detection corrected(const Detection& detection, const DetectionCorrection& correction) {
  Detection result = detection;
  result.azimuth_rad *= correction.azimuth_scale;
  result.doppler_mps =
      (detection.doppler_mps - correction.doppler_offset_mps) * correction.doppler_scale;
  result.range_std_m *= correction.range_std_factor;
  result.azimuth_std_rad *= correction.azimuth_std_factor;
  result.doppler_std_mps *= correction.doppler_std_factor;
  return result;
}

Symmetric2 polar_covariance(double range_m, double bearing_rad, double range_std_m,
                            double azimuth_std_rad) {
  const double c = std::cos(bearing_rad);
  const double s = std::sin(bearing_rad);
  const double radial = range_std_m * range_std_m;
  const double across = range_m * azimuth_std_rad * range_m * azimuth_std_rad;
  return {c * c * radial + s * s * across, c * s * (radial - across),
          s * s * radial + c * c * across};
}

TargetSet& TargetSet::operator=(const TargetSet& other) {
  size_ = other.size_;
  std::copy(other.begin(), other.end(), targets_.begin());
  return *this;
}

void TargetSet::scale_doppler(double factor) {
  std::for_each(targets_.begin(), targets_.begin() + static_cast<std::ptrdiff_t>(size_),
                [&](Target& target) { target.doppler_mps *= factor; });
}

void TargetSet::add(const Target& target) {
  if (size_ < targets_.size()) {
    targets_[size_++] = target;
  }
}

void TargetSet::add(const Detection& detection, const Pose2& vehicle_from_radar) {
  if (size_ == targets_.size()) {
    return;
  }
  const double bearing_rad = detection.azimuth_rad + vehicle_from_radar.yaw_rad;
  Target& target = targets_[size_++];
  target.bearing_rad = bearing_rad;
  target.cos_bearing = std::cos(bearing_rad);
  target.sin_bearing = std::sin(bearing_rad);
  target.x_m = vehicle_from_radar.x_m + detection.range_m * target.cos_bearing;
  target.y_m = vehicle_from_radar.y_m + detection.range_m * target.sin_bearing;
  target.covariance_m2 = polar_covariance(detection.range_m, bearing_rad, detection.range_std_m,
                                          detection.azimuth_std_rad);
  if (!(detection.range_std_m > 0.0)) {
    target.covariance_m2.xx =
        std::numeric_limits<double>::quiet_NaN();  // the square would hide the error
  }
  target.bearing_std_rad = detection.azimuth_std_rad;
  target.doppler_mps = detection.doppler_mps;
  target.doppler_std_mps = detection.doppler_std_mps;
}

void TargetSet::assign(const RadarScan& scan, const Pose2& vehicle_from_radar,
                       const DetectionLimits& limits, SelectionCounters& counters,
                       const DetectionCorrection& correction) {
  clear();
  const std::size_t count = std::min<std::size_t>(scan.count, scan.detections.size());
  const double lead_s = correction.rotation_lead_s;
  const double turn_back_rad = lead_s != 0.0 ? lead_s * reported_yaw_rate_radps(scan) : 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_selected(scan.detections[i], limits, counters)) {
      const Detection at_stamp = turned(scan.detections[i], turn_back_rad);
      add(corrected(at_stamp, correction), vehicle_from_radar);
    }
  }
}

bool TargetSet::is_finite() const { return std::all_of(begin(), end(), is_finite_target); }

}  // namespace cremed
