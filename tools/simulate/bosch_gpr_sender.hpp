// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "tools/simulate/radar_sender.hpp"

namespace cremed {

/// A Bosch GPR: always sends 48 slots. The drawn errors have exactly the reported standard
/// deviations of range, azimuth and Doppler, rounding included.
class BoschGprSender : public RadarSender {
 public:
  BoschGprSender(const BoschGprOptions& options, const Scene& scene, const SenderSetup& setup);

 protected:
  [[nodiscard]] PolarStd noise(const RadarView& view) const override;
  void encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
              std::vector<CanFrame>& list) override;
  void finish(CanFrame& frame, std::int64_t age_us) override;

 private:
  [[nodiscard]] BoschGprTargetA target_a(const Measurement& measurement) const;
  BoschGprTargetB target_b(const Measurement& measurement);

  BoschGprOptions options_;
};

}  // namespace cremed
