// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/odometry_writer.hpp"

namespace cremed {

OdometryWriter::OdometryWriter(const std::string& path) : file_(path) {
  file_.write(kOdometryCsvHeader);
}

void OdometryWriter::on_odometry(const Odometry& odometry) {
  file_.write(odometry_csv_row(odometry).view());
}

TextLine odometry_csv_row(const Odometry& odometry) {
  TextLine line;
  line.integer(odometry.utime_us).text(",").integer(odometry.utime_anchor_us).text(",");
  line.text(to_string(odometry.status));
  line.numbers(odometry.pose).upper_triangle(odometry.covariance).numbers(odometry.odom_pose);
  line.numbers(odometry.twist).upper_triangle(odometry.twist_covariance).text("\n");
  return line;
}

}  // namespace cremed
