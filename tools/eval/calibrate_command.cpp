// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate_command.hpp"

#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "daemon/configuration.hpp"
#include "daemon/message_text.hpp"
#include "tools/eval/calibration.hpp"

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
  const FittedRadar& fit = radar.fit;
  std::fprintf(stderr, "  %-22s", column.label);
  if (!radar.is_observed[column.state]) {
    std::fprintf(stderr, "not observable; kept %.*f\n", column.decimals,
                 fit.value[column.state] * column.unit);
    return;
  }
  std::fprintf(stderr, "%.*f +- %.*f (was %.*f)\n", column.decimals,
               fit.value[column.state] * column.unit, column.decimals,
               fit.std[column.state] * column.unit, column.decimals,
               fit.prior[column.state] * column.unit);
}

void print_factor(const char* label, const NoiseFactor& factor) {
  if (factor.std > 0.0) {
    std::fprintf(stderr, "  %-22s%.3f +- %.3f\n", label, factor.value, factor.std);
  } else {
    std::fprintf(stderr, "  %-22snot observable; kept\n", label);
  }
}

void print_table(const Configuration& configuration, const std::vector<RadarCalibration>& radars) {
  for (std::size_t i = 0; i < radars.size(); ++i) {
    std::fprintf(stderr, "%s, %zu scans\n", configuration.radars[i].name.c_str(), radars[i].scans);
    for (const Column& column : kColumns) {
      print_state(radars[i], column);
    }
    print_factor("range std factor", radars[i].range);
    print_factor("azimuth std factor", radars[i].azimuth);
    print_factor("Doppler std factor", radars[i].doppler);
  }
}

void print_toml(const Configuration& configuration) {
  for (const RadarConfiguration& radar : configuration.radars) {
    const Pose2& mount = radar.ego_motion.vehicle_from_radar;
    const DetectionCorrection& correction = radar.ego_motion.correction;
    std::printf("# For the [[radar]] table of %s.\n", radar.name.c_str());
    std::printf("mount = { x_m = %.3f, y_m = %.3f, yaw_rad = %.5f }\n", mount.x_m, mount.y_m,
                mount.yaw_rad);
    std::printf("calibration.stamp_offset_s = %.4f\n", radar.stamp_offset_s);
    std::printf("calibration.doppler_offset_mps = %.4f\n", correction.doppler_offset_mps);
    std::printf("calibration.range_std_factor = %.3f\n", correction.range_std_factor);
    std::printf("calibration.azimuth_std_factor = %.3f\n", correction.azimuth_std_factor);
    std::printf("calibration.doppler_std_factor = %.3f\n\n", correction.doppler_std_factor);
  }
}

std::unique_ptr<TrueTrajectory> read_truth(const std::string& path) {
  if (path.empty()) {
    return nullptr;
  }
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error(concat({"cannot read ", path}));
  }
  return std::make_unique<TrueTrajectory>(file);
}

}  // namespace

void run_calibrate(const CalibrateArguments& arguments) {
  const Configuration configuration = load_configuration(arguments.config);
  const auto truth = read_truth(arguments.truth);
  const auto radars = calibrate(configuration, arguments.logs, truth.get());
  print_table(configuration, radars);
  print_toml(calibrated(configuration, radars));
}

}  // namespace cremed
