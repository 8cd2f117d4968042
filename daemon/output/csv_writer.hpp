// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/output/odometry_sink.hpp"
#include "daemon/output/text_line.hpp"
#include "daemon/process/output_file.hpp"

namespace cremed {

inline constexpr std::string_view kMotionCsvHeader =
    "utime_start,utime,source,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw,"
    "status,targets,iterations,solve_us\n";

/// One row; nan for the motion if there is no estimate.
TextLine motion_csv_row(std::string_view source, const EgoMotion& motion, std::int32_t solve_us);

/// Ego-motions as CSV, one row per scan of each radar and per fused motion.
class CsvWriter final : public OdometrySink {
 public:
  /// `radars`: their names. Throws std::runtime_error if the file cannot be created.
  CsvWriter(const std::string& path, std::vector<std::string> radars);

  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  void on_fused(const EgoMotion& motion, std::int32_t solve_us) override;
  [[nodiscard]] std::uint64_t failures() const override { return file_.failures(); }
  [[nodiscard]] std::string problem() const override { return file_.problem(); }

 private:
  OutputFile file_;
  std::vector<std::string> radars_;
};

}  // namespace cremed
