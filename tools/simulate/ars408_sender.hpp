// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "can_decoders/ars408.hpp"
#include "tools/simulate/radar_sender.hpp"

namespace cremed {

/// An ARS408 that sends clusters, or each of its targets as an object.
///
/// The radar reports standard deviations of x, y and both velocities, but only as codes, and who
/// reads them turns them into those of range, azimuth and Doppler by the Jacobian of the polar
/// measurement, without the covariance of range and azimuth. So the simulator goes the same way:
/// codes first, polar standard deviations from them, and independent errors of range, azimuth and
/// Doppler with those. What the reader computes is then the truth about the errors.
class Ars408Sender : public RadarSender {
 public:
  static constexpr std::size_t kMaxClusters = 125;
  static constexpr std::size_t kMaxObjects = 100;

  Ars408Sender(const Ars408Options& options, const Scene& scene, const SenderSetup& setup);

 protected:
  [[nodiscard]] PolarStd noise(const RadarView& view) const override;
  void encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
              std::vector<CanFrame>& list) override;

 private:
  [[nodiscard]] bool sends_objects() const { return options_.output == Ars408Output::objects; }
  void encode_clusters(const std::vector<Measurement>& targets, std::uint16_t counter,
                       std::vector<CanFrame>& list);
  void encode_objects(const std::vector<Measurement>& targets, std::uint16_t counter,
                      std::vector<CanFrame>& list);
  Ars408General cluster(const Measurement& measurement);
  Ars408General object(const Measurement& measurement, const Ars408RmsCodes& rms);
  Ars408ClusterQuality cluster_quality(const Ars408RmsCodes& rms);
  Ars408DynProp dyn_prop(const Echo& echo);

  Ars408Options options_;
};

}  // namespace cremed
