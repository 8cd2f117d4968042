// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate_command.hpp"

#include <cstdio>
#include <memory>

#include "daemon/configuration.hpp"
#include "tools/eval/calibration.hpp"
#include "tools/eval/input_file.hpp"

namespace cremed {
namespace {

struct Column {
  CalibrationState state;
  const char* label;
  double unit;
  int decimals;
};

constexpr double kDegrees = 57.295779513082321;
constexpr Column kColumns[] = {{kYaw, "yaw deg", kDegrees, 2},
                               {kX, "x m", 1.0, 3},
                               {kY, "y m", 1.0, 3},
                               {kOffset, "Doppler offset m/s", 1.0, 3},
                               {kStamp, "stamp offset ms", 1e3, 1}};

void print_state(const RadarCalibration& radar, const Column& column) {
  const CalibrationState state = column.state;
  const FittedRadar& fit = radar.is_changed[state] ? radar.fit : radar.free;
  const auto number = [&](double value) { return value * column.unit; };
  std::fprintf(stderr, "  %-20s", column.label);
  if (fit.prior_std[state] == 0.0) {
    std::fprintf(stderr, "%10.*f  reference for the other radars\n", column.decimals,
                 number(fit.value[state]));
    return;
  }
  std::fprintf(stderr, "%10.*f +- %.*f  %s %.*f\n", column.decimals, number(fit.value[state]),
               column.decimals, number(fit.std[state]), radar.is_changed[state] ? "was" : "kept",
               column.decimals, number(fit.prior[state]));
}

void print_factor(const char* label, const NoiseFactor& factor) {
  if (factor.std > 0.0) {
    std::fprintf(stderr, "  %-20s%10.3f +- %.3f\n", label, factor.value, factor.std);
  } else {
    std::fprintf(stderr, "  %-20s%10s\n", label, "unknown");
  }
}

void print_table(const Configuration& configuration, const std::vector<RadarCalibration>& radars) {
  std::fprintf(stderr, "kept: the drive does not tell better\n");
  for (std::size_t i = 0; i < radars.size(); ++i) {
    std::fprintf(stderr, "%s, %zu scans\n", configuration.radars[i].name.c_str(), radars[i].scans);
    for (const Column& column : kColumns) {
      print_state(radars[i], column);
    }
    print_factor("range std factor", radars[i].noise.range);
    print_factor("azimuth std factor", radars[i].noise.azimuth);
    print_factor("Doppler std factor", radars[i].noise.doppler);
  }
}

void print_key(const char* key, double value, double without) {
  if (value != without) {
    std::printf("calibration.%s = %.4f\n", key, value);
  }
}

void print_toml(const RadarConfiguration& radar) {
  const Pose2& mount = radar.ego_motion.vehicle_from_radar;
  const DetectionCorrection& correction = radar.ego_motion.correction;
  const DetectionCorrection none;
  std::printf("# %s\n", radar.name.c_str());
  std::printf("mount = { x_m = %.3f, y_m = %.3f, yaw_rad = %.5f }\n", mount.x_m, mount.y_m,
              mount.yaw_rad);
  print_key("stamp_offset_s", radar.stamp_offset_s, 0.0);
  print_key("doppler_offset_mps", correction.doppler_offset_mps, none.doppler_offset_mps);
  print_key("range_std_factor", correction.range_std_factor, none.range_std_factor);
  print_key("azimuth_std_factor", correction.azimuth_std_factor, none.azimuth_std_factor);
  print_key("doppler_std_factor", correction.doppler_std_factor, none.doppler_std_factor);
}

std::unique_ptr<TrueTrajectory> read_truth(const std::string& path) {
  if (path.empty()) {
    return nullptr;
  }
  return with_input(path,
                    [](std::istream& input) { return std::make_unique<TrueTrajectory>(input); });
}

}  // namespace

void run_calibrate(const CalibrateArguments& arguments) {
  const Configuration configuration = load_configuration(arguments.config);
  const auto truth = read_truth(arguments.truth);
  const auto radars = calibrate(configuration, arguments.logs, truth.get());
  print_table(configuration, radars);
  for (const RadarConfiguration& radar : calibrated(configuration, radars).radars) {
    print_toml(radar);
  }
}

}  // namespace cremed
