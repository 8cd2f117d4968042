// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/csv_writer.hpp"

#include <utility>

#include "daemon/text_line.hpp"

namespace cremed {

CsvWriter::CsvWriter(const std::string& path, std::vector<std::string> sources)
    : file_(path), sources_(std::move(sources)) {
  file_.write(kHeader);
}

void CsvWriter::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) {
  TextLine line;
  line.integer(motion.utime_start_us).text(",").integer(motion.utime_us).text(",");
  line.text(sources_[radar]);
  for (Eigen::Index i = 0; i < 3; ++i) {
    line.text(",").fixed(motion.motion(i), 9);
  }
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = row; column < 3; ++column) {
      line.text(",").scientific(motion.covariance(row, column), 9);
    }
  }
  line.text(",").text(to_string(motion.status));
  line.text(",").integer(motion.targets).text(",").integer(motion.iterations);
  line.text(",").integer(solve_us).text("\n");
  file_.write(line.view());
}

}  // namespace cremed
