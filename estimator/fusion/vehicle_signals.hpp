// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/doubt/radar/nis_mean.hpp"
#include "cremed/estimator/doubt/vehicle/radar_trust.hpp"
#include "cremed/estimator/doubt/vehicle/signal_check.hpp"
#include "cremed/estimator/doubt/vehicle/signal_trust.hpp"
#include "cremed/estimator/doubt/vehicle/standing_value.hpp"
#include "cremed/estimator/fusion/measurement/signal_track.hpp"
#include "cremed/estimator/fusion/output/odometry_output.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Speed and yaw rate of the vehicle's bus as measurements of the filter's state
/// (VehicleMeasurement), each with a gate. A signal is left out, and does not change the state, if
/// it repeatedly contradicts the filter, if its learned errors exceed those of sensors and radars,
/// or if SignalCheck finds a fault. A value that repeats (StandingValue) is not used. A signal that
/// is frozen or lost is reported.
class VehicleSignals {
 public:
  /// Both must outlive this object.
  VehicleSignals(OdometryState& state, OdometryOutput& output);

  /// A reading, in the order of the stamps of its signal. Ignored if the options do not use it.
  void add(const VehicleReading& reading);
  /// A radar's own motion from scan to scan, with which the readings are compared.
  void compare(const Pose2& mount, const EgoMotion& motion);
  /// Uses what was measured until `stamp_us`. The state may move on, but not beyond that time.
  /// `is_known`: the state no longer depends on its prior. Otherwise readings are discarded: the
  /// radars alone start the filter. True if a signal that was used is found wrong: the state has
  /// been corrected by what it followed.
  bool use_until(std::int64_t stamp_us, bool is_known);
  /// Notes which signals are lost at this time; use_until() does so too.
  void note_lost(std::int64_t stamp_us);
  /// Discards the readings; to be called when the clock was set.
  void forget();
  /// Resets the learned errors, which a wrong state may have corrupted.
  void restart_errors();

  [[nodiscard]] VehicleSignalReport report(VehicleSignal signal) const;

 private:
  /// A fault that comes and goes.
  struct Fault {
    bool is_present = false;
    int times = 0;

    void update(bool is_now_present) {
      times += is_now_present && !is_present ? 1 : 0;
      is_present = is_now_present;
    }
  };
  struct Source {
    Source(VehicleSignal which, const VehicleOptions& options);

    VehicleSignal signal;
    SignalTrack track;
    StandingValue standing;
    SignalCheck check;
    SignalTrust trust;
    NoiseFactor noise;
    NisMean nis;
    Fault lost;
    Fault frozen;
    std::uint64_t readings = 0;
    std::uint64_t used = 0;
    std::optional<std::int64_t> heard_us;     // Last reading; before the first, the first look.
    std::optional<std::int64_t> compared_us;  // Last measurement.
  };

  [[nodiscard]] bool is_used(VehicleSignal signal) const;
  void watch(Source& source, bool is_known);
  Source* earliest();
  void look_anew(const Source& source);
  bool use(Source& source, const SignalTrack::Value& value);
  [[nodiscard]] double unverified_variance(const Source& source, double value) const;
  bool judge(Source& source, const Innovation& innovation);
  void leave_out(Source& source);
  [[nodiscard]] bool has_credible_errors(const Source& source) const;

  OdometryState& state_;
  OdometryOutput& output_;
  std::array<Source, kVehicleSignals> sources_;
};

}  // namespace cremed
