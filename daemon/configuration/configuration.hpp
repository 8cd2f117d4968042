// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/option_reader.hpp"
#include "cremed/can_decoders/radar_family.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "daemon/configuration/bus_options.hpp"
#include "daemon/process/usage_error.hpp"

namespace cremed {

/// Limit of the configuration; a bus has at most eight ARS408.
inline constexpr std::size_t kMaxRadars = 16;

/// Name of the motion of all radars in messages and files; not allowed for a radar.
inline constexpr std::string_view kFusedSource = "fused";

/// Name of the vehicle's state as source of the trajectory; not allowed for a radar.
inline constexpr std::string_view kOdometrySource = "odometry";

/// Limits of keys of [radar.calibration] that are also advised.
inline constexpr Range kDopplerScales{0.5, 2.0};
inline constexpr Range kStampOffsetsS{-0.5, 0.5};

/// One [[radar]] table.
struct RadarConfiguration {
  std::string name;       ///< Unique without regard to case; 1 to 15 letters, digits, _ or -.
  std::string interface;  ///< CAN interface in the log or on the computer, e.g. "can0".
  RadarSettings decoder = Ars408Options{};
  double scan_timeout_s = 0.03;  ///< An open scan closes after this time without a part.
  double stamp_offset_s = 0.0;   ///< Added to the stamps of the scans.
  EgoMotionOptions ego_motion;
};

struct OdometryConfiguration {
  bool enabled = true;
  std::string state_file;  ///< File of the learned errors (LearnedFile); empty: none.
  OdometryOptions filter;

  bool operator==(const OdometryConfiguration&) const = default;
};

/// Speed and yaw rate that another node sends, in the layout of 0x300 and 0x301.
struct VehicleConfiguration {
  std::string interface;  ///< CAN interface; empty: off.
  /// By VehicleSignal.
  std::array<std::optional<std::uint32_t>, kVehicleSignals> ids{0x300, 0x301};

  [[nodiscard]] std::optional<std::uint32_t> id(VehicleSignal signal) const {
    return ids[static_cast<std::size_t>(signal)];
  }
  [[nodiscard]] bool is_used(VehicleSignal signal) const {
    return !interface.empty() && id(signal).has_value();
  }

  bool operator==(const VehicleConfiguration&) const = default;
};

struct OutputConfiguration {
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";  ///< "none": no LCM.
  std::string csv;       ///< Path of the ego-motions as CSV; empty: none.
  std::string odometry;  ///< Path of the vehicle's state as CSV; empty: none.
  std::string tum;       ///< Path of the trajectory; empty: none.
  /// Source of the trajectory: a radar or the odometry. Empty: the odometry if there are two radars
  /// or more, otherwise the radar.
  std::string tum_source;
  std::string nav_msgs_odometry;  ///< LCM channel of nav_msgs.Odometry; empty: none.
  bool publish_scans = false;     ///< radar_scan_t on CREMED_SCAN_<RADAR>.

  bool operator==(const OutputConfiguration&) const = default;
};

/// Real-time scheduling and locked memory, which the service manager grants.
enum class RealTimePolicy : std::uint8_t {
  prefer,   ///< Use what is granted; log once what is missing.
  require,  ///< Do not start without them.
  off,      ///< Do not lock memory.
};

/// Options of live operation.
struct LiveConfiguration {
  RealTimePolicy real_time = RealTimePolicy::prefer;
  CanSocketOptions socket;
  double max_latency_s = 0.5;  ///< Older frames are not used, older results not sent.

  bool operator==(const LiveConfiguration&) const = default;
};

struct LoggingConfiguration {
  std::string level = "info";  ///< trace, debug, info, warn, error, off.

  bool operator==(const LoggingConfiguration&) const = default;
};

/// The content of one TOML file, validated.
struct Configuration {
  std::vector<RadarConfiguration> radars;
  OdometryConfiguration odometry;
  VehicleConfiguration vehicle;
  OutputConfiguration output;
  LiveConfiguration live;
  LoggingConfiguration logging;
};

/// what(): "file:line: key: what is wrong; what would be right", one line per error, in the order
/// of the file. For an unreadable file: "file: what is wrong; ...".
class ConfigurationError : public UsageError {
 public:
  using UsageError::UsageError;
};

/// Whether the motion of all radars, "fused", is published.
bool is_fused(const Configuration& configuration);

/// The radar that the trajectory follows; nothing: the odometry.
std::optional<std::size_t> tum_radar(const Configuration& configuration);

/// Parses and validates a text. `file_name` is for messages only; `families` are the allowed radar
/// types.
Configuration parse_configuration(std::string_view toml, const std::string& file_name,
                                  RadarFamilies families = radar_families());

/// Reads and parses a file. Throws ConfigurationError, also if the file is unreadable.
Configuration load_configuration(const std::string& path);

}  // namespace cremed
