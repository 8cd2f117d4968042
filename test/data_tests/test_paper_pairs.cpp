// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The paper's estimator, from a drive's CAN log, gives what the reference implementation gives from
// the prepared pairs.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/median.hpp"
#include "test/data_tests/shared_data.hpp"
#include "tools/eval/csv_table.hpp"
#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/table/drive_pairs.hpp"

using namespace cremed;

namespace {

/// Mount of the data set, which the reference has as well.
const std::string kFront =
    "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"can0\"\n"
    "mount = { x_m = 3.412, y_m = 0.0, yaw_rad = 0.003490659 }\n";

std::string unpacked(const TemporaryFolder& folder, const std::string& name) {
  const std::string path = folder.file("file" + std::filesystem::path(name).stem().string());
  std::ofstream(path) << read_shared("data/nuscenes/scene-0061/" + name);
  return path;
}

}  // namespace

TEST_CASE("cremed-eval table --real begins with the pairs of the reference implementation") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("front.toml")) << kFront;
  const DrivePairs pairs =
      pair_drive({unpacked(folder, "can.log.xz"), unpacked(folder, "truth.csv"),
                  load_configuration(folder.file("front.toml")), TruthNoise{}},
                 "nuscenes");
  REQUIRE(pairs.paper_doppler.motions.size() == 245);
  std::istringstream text(read_shared("data/registration/nuscenes-front.msm-d.reference.csv"));
  const CsvTable reference(text);
  std::vector<double> x_m;
  std::vector<double> yaw_rad;
  std::vector<double> variance;
  for (std::size_t row = 0; row < 245; ++row) {
    const auto number = [&](const char* name) {
      return reference.number(row, reference.column(name));
    };
    const PairedMotion& ours = pairs.paper_doppler.motions[row];
    x_m.push_back(std::abs(ours.motion.x() - number("x")));
    yaw_rad.push_back(std::abs(ours.motion.z() - number("yaw")));
    variance.push_back(std::abs(ours.covariance(0, 0) / number("cxx") - 1.0));
  }
  CHECK(median_or(INFINITY, x_m.begin(), x_m.end()) < 1e-4);
  CHECK(median_or(INFINITY, yaw_rad.begin(), yaw_rad.end()) < 1e-4);
  CHECK(median_or(INFINITY, variance.begin(), variance.end()) < 1e-3);
}
