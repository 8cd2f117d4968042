// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/output/odometry_sink.hpp"
#include "daemon/output/text_line.hpp"
#include "daemon/process/output_file.hpp"

namespace cremed {

inline constexpr std::string_view kOdometryCsvHeader =
    "utime,utime_anchor,status,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw,"
    "odom_x_m,odom_y_m,odom_yaw_rad,vx_mps,vy_mps,yaw_rate_radps,"
    "cov_vxvx,cov_vxvy,cov_vxw,cov_vyvy,cov_vyw,cov_ww\n";

/// One row.
TextLine odometry_csv_row(const Odometry& odometry);

/// The state of the vehicle as CSV, a row per output.
class OdometryWriter final : public OdometrySink {
 public:
  /// Throws std::runtime_error if the file cannot be created.
  explicit OdometryWriter(const std::string& path);

  void on_odometry(const Odometry& odometry) override;
  [[nodiscard]] std::uint64_t failures() const override { return file_.failures(); }
  [[nodiscard]] std::string problem() const override { return file_.problem(); }

 private:
  OutputFile file_;
};

}  // namespace cremed
