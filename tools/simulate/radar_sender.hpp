// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/estimator/scan/detection_options.hpp"
#include "tools/simulate/can_bus.hpp"
#include "tools/simulate/radar_model.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/scene.hpp"
#include "tools/simulate/slow_error.hpp"
#include "tools/simulate/told_motion.hpp"

namespace cremed {

/// The truth behind the detections of one scan, in their order.
struct ScanTruth {
  std::size_t radar = 0;  ///< Index in the list of radars.
  std::int64_t stamp_us = 0;
  std::vector<Echo> echoes;
};

using ScanObserver = std::function<void(const ScanTruth&)>;

/// Errors common to all Doppler of one radar.
struct DopplerErrors {
  double factor = 1.0;          ///< Measured over true.
  double offset_mps = 0.0;      ///< Constant.
  double offset_std_mps = 0.0;  ///< Of another offset, slowly varying.
};

/// Settings common to all radars of a simulation.
struct SenderSetup {
  std::size_t radar = 0;
  Pose2 vehicle_from_radar;    ///< True mount.
  Pose2 stated_mount;          ///< Mount in the configuration.
  bool is_told_motion = true;  ///< Receives speed and yaw rate, if its family supports that.
  /// Of the configuration: the radar has the errors that this corrects, and its noise.
  DetectionCorrection correction;
  std::uint64_t seed = 1;
  std::size_t max_targets = 0;
  DopplerErrors doppler;
  FaultOptions faults;
  ScanObserver observer;  ///< May be empty.
};

/// Standard deviations of a measurement's independent errors.
struct PolarStd {
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double doppler_mps = 0.0;
};

/// One target as measured, before rounding to the frame.
struct Measurement {
  Echo echo;
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double doppler_mps = 0.0;
};

/// Shortest and longest time between two scans.
struct ScanCycle {
  std::int64_t least_us = 0;
  std::int64_t greatest_us = 0;
};

/// A radar on the bus: measures once a cycle, when the first frame of the list is complete, and
/// sends the list.
class RadarSender : public BusSender {
 public:
  [[nodiscard]] FrameRequest request() const override;
  CanFrame send(std::int64_t stamp_us) override;

 protected:
  /// `first_frame`: identifier and length of the first frame of every list.
  RadarSender(const RadarCharacter& character, const ScanCycle& cycle, const CanFrame& first_frame,
              const Scene& scene, const SenderSetup& setup);

  /// Noise to draw, so that after rounding the errors have the reported standard deviations.
  [[nodiscard]] virtual PolarStd noise(const RadarView& view) const = 0;

  /// Whether the target fits into a frame; otherwise it is not sent.
  [[nodiscard]] virtual bool can_report(const Measurement& /*measurement*/) const { return true; }

  /// Appends all frames of a scan. `cycle` counts the scans since power-on.
  virtual void encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
                      std::vector<CanFrame>& list) = 0;

  /// Final changes to a frame when it is sent, `age_us` after the measurement.
  virtual void finish(CanFrame& frame, std::int64_t age_us);

  /// The azimuth at which the radar measures a target that is at this one.
  [[nodiscard]] double measured_azimuth_rad(double azimuth_rad) const {
    return azimuth_rad / setup_.correction.azimuth_scale;
  }
  [[nodiscard]] Random& random() { return random_; }
  [[nodiscard]] const SenderSetup& setup() const { return setup_; }
  /// Doppler of the last scan without the target's own noise.
  [[nodiscard]] double with_shared_errors(double doppler_mps) const {
    return setup_.doppler.factor * doppler_mps + doppler_offset_mps_;
  }
  /// The motion received when the last scan was measured; zero if none.
  [[nodiscard]] const ToldMotion& told() const { return told_; }

 private:
  void start_scan(std::int64_t stamp_us);
  void measure(const std::vector<Echo>& echoes);
  void schedule_next();
  [[nodiscard]] bool silent(std::int64_t stamp_us) const;
  [[nodiscard]] bool at_end_of(double period_s, double part_s, std::int64_t stamp_us) const;
  void report_truth() const;

  ScanCycle cycle_;
  CanFrame first_frame_;
  const Scene& scene_;
  SenderSetup setup_;
  Random random_;
  RadarModel model_;
  std::int64_t next_scan_us_ = 0;
  std::int64_t scan_stamp_us_ = 0;
  std::uint32_t cycle_count_ = 0;
  SlowError slow_offset_;
  double doppler_offset_mps_ = 0.0;  // Of the last scan.
  ToldMotion told_;                  // Of the last scan.
  std::vector<Measurement> targets_;
  std::vector<CanFrame> list_;
  std::size_t sent_ = 0;
};

}  // namespace cremed
