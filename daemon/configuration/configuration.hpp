// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/radar_family.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "daemon/configuration/bus_options.hpp"

namespace cremed {

/// More is refused: a bus has at most eight ARS408.
inline constexpr std::size_t kMaxRadars = 16;

/// What the motion of all radars is named in messages and files; no radar may be.
inline constexpr std::string_view kFusedSource = "fused";

/// What the state of the vehicle is named where the trajectory follows it; no radar may be.
inline constexpr std::string_view kOdometrySource = "odometry";

/// One [[radar]] table.
struct RadarConfiguration {
  std::string name;       ///< Unique whatever its case; at most 15 of letters, digits, _ and -.
  std::string interface;  ///< CAN interface as in the log or on the computer, e.g. "can0".
  RadarSettings decoder = Ars408Options{};
  double scan_timeout_s = 0.03;  ///< An open scan with no new part for this long is closed.
  double stamp_offset_s = 0.0;   ///< Added to the stamps of its scans.
  EgoMotionOptions ego_motion;
};

struct OdometryConfiguration {
  bool enabled = true;
  std::string state_file;  ///< Path of what was learned (LearnedFile); empty: none.
  OdometryOptions filter;
};

struct OutputConfiguration {
  std::string lcm_url = "udpm://239.255.76.67:7667?ttl=0";  ///< "none": no LCM.
  std::string csv;       ///< Path of the ego-motions as CSV; empty: none.
  std::string odometry;  ///< Path of the vehicle's state as CSV; empty: none.
  std::string tum;       ///< Path of the trajectory; empty: none.
  /// What the trajectory follows: a radar, or the odometry. Empty: the odometry where there are two
  /// radars or more, otherwise the radar.
  std::string tum_source;
  std::string nav_msgs_odometry;  ///< LCM channel of nav_msgs.Odometry; empty: none.
  bool publish_scans = false;     ///< radar_scan_t on CREMED_SCAN_<RADAR>.
};

/// What to do about real-time scheduling and locked memory, which the service manager grants.
enum class RealTimePolicy : std::uint8_t {
  prefer,   ///< Use what there is, and say once what is missing.
  require,  ///< Do not start without.
  off,      ///< Do not lock memory.
};

/// Running on a live bus.
struct LiveConfiguration {
  RealTimePolicy real_time = RealTimePolicy::prefer;
  CanSocketOptions socket;
  double max_latency_s =
      0.5;  ///< Frames that waited for longer before they were read are not used.
};

struct LoggingConfiguration {
  std::string level = "info";  ///< trace, debug, info, warn, error, off.
};

/// All of one TOML file, validated.
struct Configuration {
  std::vector<RadarConfiguration> radars;
  OdometryConfiguration odometry;
  OutputConfiguration output;
  LiveConfiguration live;
  LoggingConfiguration logging;
  std::string warnings;  ///< "file:line: key: what to write instead", one a line; "": none.
};

/// what(): "file:line: key: what is wrong; what would be right", a line for each error, in the
/// order of the file; a file that cannot be read: "file: what is wrong; ...".
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether there is a motion of all radars together, "fused".
bool is_fused(const Configuration& configuration);

/// The radar that the trajectory follows; nothing: the odometry.
std::optional<std::size_t> tum_radar(const Configuration& configuration);

/// Parses and validates everything before anything is opened. `file_name` is for messages only;
/// `families` are the types that a radar may have.
Configuration parse_configuration(std::string_view toml, const std::string& file_name,
                                  RadarFamilies families = radar_families());

/// Reads and parses a file; a file that cannot be read is a ConfigurationError too.
Configuration load_configuration(const std::string& path);

/// Every key of the file as "table.key", for the test that the manual names them all. Those of
/// [radar.estimator] are listed under "radar.estimator" too.
std::set<std::string> known_configuration_keys();

}  // namespace cremed
