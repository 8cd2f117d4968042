// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/csv_writer.hpp"

#include <utility>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

TextLine motion_csv_row(std::string_view source, const EgoMotion& motion, std::int32_t solve_us) {
  TextLine line;
  line.integer(motion.utime_start_us).text(",").integer(motion.utime_us).text(",");
  line.text(source);
  line.numbers(motion.motion).upper_triangle(motion.covariance);
  line.text(",").text(to_string(motion.status));
  line.text(",").integer(motion.targets).text(",").integer(motion.iterations);
  line.text(",").integer(solve_us).text("\n");
  return line;
}

CsvWriter::CsvWriter(const std::string& path, std::vector<std::string> radars)
    : file_(path), radars_(std::move(radars)) {
  file_.write(kMotionCsvHeader);
}

void CsvWriter::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) {
  file_.write(motion_csv_row(radars_[radar], motion, solve_us).view());
}

void CsvWriter::on_fused(const EgoMotion& motion, std::int32_t solve_us) {
  file_.write(motion_csv_row(kFusedSource, motion, solve_us).view());
}

}  // namespace cremed
