// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "tools/simulate/radar_sender.hpp"

namespace cremed {

/// An ARS408 that sends clusters, or each of its targets as an object.
///
/// The radar reports standard deviations of x, y and both velocities as codes. The reader converts
/// these to range, azimuth and Doppler with the Jacobian of the polar measurement, without the
/// covariance of range and azimuth. The simulator does the same: codes first, polar standard
/// deviations from them, and independent errors of range, azimuth and Doppler. The reader's noise
/// is then the true noise.
///
/// Measured on real drives (nuScenes, ten ARS408): a cluster's relative velocity is
///     V = D u + A t
/// with the line of sight u when the scan was measured, t to its left, the Doppler D, and the
/// velocity A across the line of sight of a static target there by the speed and yaw rate w that
/// the sensor receives (static_across_mps). The radar cannot measure A, so moving targets have it
/// too. The reported position is extrapolated: turned by -w tau (calibration.rotation_lead_s, 40
/// ms), at the same range. Without speed and yaw rate the sensor reports A = 0, does not turn
/// positions, and takes everything with Doppler for moving. All azimuths that it measures are the
/// true ones over calibration.azimuth_scale. An object's velocity is tracked: its
/// component across is the target's own.
class Ars408Sender : public RadarSender {
 public:
  static constexpr std::size_t kMaxClusters = 125;
  static constexpr std::size_t kMaxObjects = 100;

  Ars408Sender(const Ars408Options& options, const Scene& scene, const SenderSetup& setup);

 protected:
  [[nodiscard]] PolarStd noise(const RadarView& view) const override;
  [[nodiscard]] bool can_report(const Measurement& measurement) const override;
  void encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
              std::vector<CanFrame>& list) override;

 private:
  [[nodiscard]] bool sends_objects() const { return options_.output == Ars408Output::objects; }
  void encode_clusters(const std::vector<Measurement>& targets, std::uint16_t counter,
                       std::vector<CanFrame>& list);
  void encode_objects(const std::vector<Measurement>& targets, std::uint16_t counter,
                      std::vector<CanFrame>& list);
  [[nodiscard]] Ars408General mounted(Ars408General target) const;
  Ars408General cluster(const Measurement& measurement);
  Ars408General object(const Measurement& measurement, const Ars408RmsCodes& rms);
  Ars408ClusterQuality cluster_quality(const Ars408RmsCodes& rms);
  Ars408General general(const Measurement& measurement, double doppler_mps, double across_mps);
  Ars408DynProp dyn_prop(const Echo& echo);
  /// The reported azimuth of a target measured at this one, or of one seen so.
  [[nodiscard]] double reported_azimuth_rad(double measured_rad) const;
  [[nodiscard]] double reported_azimuth_rad(const RadarView& view) const {
    return reported_azimuth_rad(measured_azimuth_rad(view.azimuth_rad));
  }
  [[nodiscard]] double static_across(double range_m, double azimuth_rad) const;
  [[nodiscard]] Ars408RmsCodes rms_codes(const RadarView& view) const;

  Ars408Options options_;
};

}  // namespace cremed
