// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/calibrate_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/replaced_file.hpp"
#include "tools/eval/calibrate/calibration.hpp"
#include "tools/eval/calibrate/calibration_keys.hpp"
#include "tools/eval/calibrate/configuration_edit.hpp"
#include "tools/eval/drive/missing_time.hpp"
#include "tools/eval/input_file.hpp"

namespace cremed {
namespace {

struct Column {
  CalibrationState state;
  const char* label;
  double unit;
  int decimals;
};

constexpr Column kColumns[] = {{kYaw, "yaw deg", kDegPerRad, 2},
                               {kX, "x m", 1.0, 3},
                               {kY, "y m", 1.0, 3},
                               {kOffset, "Doppler offset m/s", 1.0, 3},
                               {kStamp, "stamp offset ms", 1e3, 1},
                               {kScale, "Doppler scale", 1.0, 4},
                               {kLead, "rotation lead ms", 1e3, 1},
                               {kAzimuth, "azimuth scale", 1.0, 4},
                               {kPositionLead, "positions ahead ms", 1e3, 1}};

const char* verdict(const RadarCalibration& radar, CalibrationState state) {
  if (state == kPositionLead) {
    return "a check, from";
  }
  return radar.is_changed[state] ? "was" : "kept";
}

void print_state(const RadarConfiguration& configured, const RadarCalibration& radar,
                 const Column& column) {
  const CalibrationState state = column.state;
  const FittedRadar& fit = radar.is_changed[state] ? radar.fit : radar.free;
  const auto number = [&](double value) {
    const double key = key_value(configured, state, value);
    return (state == kYaw ? std::remainder(key, 2.0 * std::numbers::pi) : key) * column.unit;
  };
  const double std = std::abs(key_value(configured, state, fit.value[state] + fit.std[state]) -
                              key_value(configured, state, fit.value[state]));
  if (fit.prior_std[state] == 0.0 && state == kLead) {
    return;  // The radar's type has no such state.
  }
  std::fprintf(stderr, "  %-22s", column.label);
  if (fit.prior_std[state] == 0.0) {
    std::fprintf(stderr, "%10.*f  reference for the other radars\n", column.decimals,
                 number(fit.value[state]));
    return;
  }
  std::fprintf(stderr, "%10.*f +- %.*f  %s %.*f\n", column.decimals, number(fit.value[state]),
               column.decimals, std * column.unit, verdict(radar, state), column.decimals,
               number(fit.prior[state] - (state == kYaw ? radar.turned_rad : 0.0)));
}

/// The factor is relative to the configured one; `after` is what the key gets.
void print_factor(const char* label, const StdFactor& factor, double configured, double after) {
  if (factor.std > 0.0) {
    std::fprintf(stderr, "  %-22s%10.3f +- %.3f  %s %.3f\n", label, configured * factor.value,
                 configured * factor.std, after != configured ? "was" : "kept", configured);
  } else {
    std::fprintf(stderr, "  %-22s%10s\n", label, "unknown");
  }
}

void print_factors(const DetectionCorrection& before, const DetectionCorrection& after,
                   const SensorNoise& noise) {
  print_factor("range std factor", noise.range, before.range_std_factor, after.range_std_factor);
  print_factor("azimuth std factor", noise.azimuth, before.azimuth_std_factor,
               after.azimuth_std_factor);
  print_factor("Doppler std factor", noise.doppler, before.doppler_std_factor,
               after.doppler_std_factor);
}

void print_vehicle(const Calibration& calibration) {
  const FittedVehicle& vehicle = calibration.vehicle;
  std::fprintf(stderr,
               "mounts are in the frame of %s; in it, the vehicle rolls at %.2f +- %.2f deg\n",
               calibration.has_truth ? "truth" : "the configured ones",
               vehicle.value[kRoll] * kDegPerRad, vehicle.std[kRoll] * kDegPerRad);
  std::fprintf(stderr, "rear axle slips by %.2f +- %.2f deg at 1 m/s^2 across%s\n",
               vehicle.value[kSlip] * kDegPerRad, vehicle.std[kSlip] * kDegPerRad,
               calibration.is_slip_refused ? ": kept, as it fits other parts of the drive no better"
               : calibration.is_slip_changed ? ""
                                             : ": kept");
}

bool is_turned(const RadarCalibration& radar) { return radar.turned_rad != 0.0; }

void print_check(const Calibration& calibration) {
  if (const auto& check = calibration.check) {
    std::fprintf(stderr,
                 "checked on each fifth of the drive with what the others give: misfit %.0f, with "
                 "%s %.0f%s\n",
                 check->found,
                 std::ranges::any_of(calibration.radars, is_turned)
                     ? "the values that the fit began with"
                     : "the configured values",
                 check->configured, check->is_better ? "" : ": no better, so that these are kept");
  }
}

void print_table(const Configuration& configuration, const Calibration& calibration) {
  const Configuration found = calibrated(configuration, calibration);
  std::fprintf(
      stderr,
      "found, as the value of its key, and the configured one: kept where the drive gives no "
      "better one\n");
  print_check(calibration);
  print_vehicle(calibration);
  for (std::size_t i = 0; i < calibration.radars.size(); ++i) {
    const RadarCalibration& radar = calibration.radars[i];
    const RadarConfiguration& configured = configuration.radars[i];
    if (radar.scans == 0) {
      std::fprintf(stderr, "%s: no scan, so that all is kept\n", configured.name.c_str());
      continue;
    }
    std::fprintf(
        stderr, "%s, %zu scans%s%s\n", configured.name.c_str(), radar.scans,
        is_turned(radar) ? ": begun with the yaw by which it moves along" : "",
        radar.is_refused ? ": what was found fits other parts of the drive no better" : "");
    for (const Column& column : kColumns) {
      print_state(configured, radar, column);
    }
    print_factors(configured.ego_motion.correction, found.radars[i].ego_motion.correction,
                  radar.noise);
  }
}

/// The fit is linear about the configured values: from a reversed mount or sign it may end
/// anywhere. On six recorded drives (nuScenes, RadarScenes 105) it moves by 0.01 rad and 0.1 at
/// most.
constexpr double kFarthestYawRad = 1.0;
constexpr double kFarthestScale = 0.5;

/// How far a radar's fit went from its configuration.
struct Distance {
  std::string name;
  double turn_rad = 0.0;
  double scale = 0.0;
  bool is_explained = true;

  /// 1: as far as a calibration finds.
  [[nodiscard]] double size() const {
    const double turn = std::abs(turn_rad) / kFarthestYawRad;
    const double scaled = std::abs(scale) / kFarthestScale;
    return is_explained ? std::max(turn, scaled) : std::numeric_limits<double>::infinity();
  }
};

Distance distance_of(const RadarConfiguration& configured, const RadarCalibration& radar) {
  const FittedRadar& fit = radar.free;
  return {configured.name,
          std::remainder(fit.value[kYaw] - fit.prior[kYaw], 2.0 * std::numbers::pi),
          fit.value[kScale], radar.scans == 0 || radar.explained_scans != 0};
}

std::string text_of(const Distance& distance) {
  return distance.is_explained
             ? fmt::format("{} (yaw off by {:.0f} degrees, Doppler by {:.0f} %)", distance.name,
                           std::abs(distance.turn_rad) * kDegPerRad,
                           std::abs(distance.scale) * 100.0)
             : concat({distance.name, " (none of its scans fits the motion of all)"});
}

/// The radars whose fit went too far, the farthest first.
std::vector<Distance> too_far(const Configuration& configuration, const Calibration& calibration) {
  std::vector<Distance> far;
  for (std::size_t i = 0; i < calibration.radars.size(); ++i) {
    const Distance distance = distance_of(configuration.radars[i], calibration.radars[i]);
    if (distance.size() > 1.0) {
      far.push_back(distance);
    }
  }
  std::ranges::sort(far, std::greater(), &Distance::size);
  return far;
}

/// Throws if a radar is configured too wrongly for its errors to be found. Which it is remains
/// open: a wrong one may draw the motion of all to itself, and others seem wrong.
void require_near(const Configuration& configuration, const Calibration& calibration) {
  const std::string names = joined(too_far(configuration, calibration), text_of);
  if (!names.empty()) {
    const bool is_alone = calibration.radars.size() == 1;
    throw std::runtime_error(concat(
        {names, ": too far off for a calibration. Its yaw or the sign of its Doppler is wrong",
         is_alone ? "" : ", or that of another radar, which it is compared with",
         "; measure the mounts again; `cremed-doctor --replay LOG` may name the cause"}));
  }
}

struct Values {
  std::vector<CalibratedValue> vehicle;
  std::vector<std::vector<CalibratedValue>> radars;
};

Values found_values(const Configuration& configuration, const Calibration& calibration) {
  const Configuration found = calibrated(configuration, calibration);
  Values values;
  values.vehicle = changed_vehicle_values(configuration.odometry.filter, found.odometry.filter);
  for (std::size_t i = 0; i < found.radars.size(); ++i) {
    values.radars.push_back(changed_values(configuration.radars[i], found.radars[i]));
  }
  return values;
}

void print_values(const std::vector<CalibratedValue>& values) {
  for (const CalibratedValue& value : values) {
    std::printf("%s = %s\n", std::string(value.key->key).c_str(), value.text.c_str());
  }
}

/// Separate tables: a [radar.mount] may be in a form that accepts no further key.
void print_toml(const Configuration& configuration, const Calibration& calibration,
                const Values& values) {
  const FittedVehicle& vehicle = calibration.vehicle;
  std::printf(
      "# Results of cremed-eval calibrate; put them before or after any table, or their keys into "
      "tables of these names.\n");
  std::printf("# yaw_rad is in the frame of %s, in which the vehicle rolls at %.4f +- %.4f rad.\n",
              calibration.has_truth ? "truth" : "the configured mounts", vehicle.value[kRoll],
              vehicle.std[kRoll]);
  if (!values.vehicle.empty()) {
    std::printf("\n[calibrated]\n");
    print_values(values.vehicle);
  }
  for (std::size_t i = 0; i < values.radars.size(); ++i) {
    if (!values.radars[i].empty()) {
      std::printf("\n[calibrated.%s]\n", configuration.radars[i].name.c_str());
      print_values(values.radars[i]);
    }
  }
}

void write_back(const std::string& path, const Values& values) {
  const std::string before = with_input(path, content);
  const std::string after = edited_configuration(before, values.radars, values.vehicle);
  if (after != before) {
    replace_file(path, after);
  }
  std::fprintf(stderr, "%s: %s\n", path.c_str(), after == before ? "unchanged" : "changed");
}

}  // namespace

void run_calibrate(const CalibrateArguments& arguments) {
  const Configuration configuration = load_configuration(arguments.config);
  std::optional<TrueTrajectory> truth;
  if (!arguments.truth.empty()) {
    truth = read_input<TrueTrajectory>(arguments.truth);
  }
  const Calibration calibration =
      calibrate(configuration, arguments.logs, truth ? &*truth : nullptr);
  require_near(configuration, calibration);
  const Values values = found_values(configuration, calibration);
  print_table(configuration, calibration);
  if (truth) {
    say_gaps(arguments.truth, truth->gaps(), truth->utime_us());
  }
  print_toml(configuration, calibration, values);
  if (arguments.write) {
    write_back(arguments.config, values);
  }
}

}  // namespace cremed
