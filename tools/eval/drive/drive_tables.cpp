// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_tables.hpp"

#include <numbers>
#include <string>

#include "cremed/estimator/scan/degrees.hpp"

namespace cremed {
namespace {

/// One axis' row; `unit` converts metres or radians.
void print_axis(std::FILE* file, const std::string& source, const char* name,
                const AxisAgainstWheels& axis, double unit) {
  std::fprintf(file, "# %-15s %-10s %6zu %9.3f %9.3f %9.3f %9.3f %9.3f %9.4f %9.4f %9.4f\n",
               source.c_str(), name, axis.count, axis.nees, axis.nees_estimate, axis.nees_truth,
               axis.nees_cross, axis.nees_against_truth(), unit * axis.rms_estimate_per_s,
               unit * axis.rms_truth_per_s, unit * axis.rms_both_per_s);
}

void print_twist(std::FILE* file, const std::string& source, const TwistAgainstWheels& twist) {
  std::fprintf(file, "# %-15s %-10s %6zu %9.3f %39s %9.4f\n", source.c_str(), "vx m/s", twist.count,
               twist.nees_speed, "", twist.rms_speed_mps);
  std::fprintf(file, "# %-15s %-10s %6zu %9.3f %39s %9.4f\n", source.c_str(), "w deg/s",
               twist.count, twist.nees_yaw_rate, "", kDegPerRad * twist.rms_yaw_rate_radps);
}

void print_truth(std::FILE* file, const std::vector<TruthAgainstWheels>& truth) {
  std::fprintf(
      file,
      "# truth against the wheels over intervals of one length, RMS; y: upper bound, includes "
      "slip in bends\n# %6s %9s %9s %9s %9s %9s %9s\n",
      "s", "intervals", "x_m", "y_m", "yaw_rad", "x_m/s", "yaw_deg/s");
  for (const TruthAgainstWheels& t : truth) {
    std::fprintf(file, "# %6.3f %9zu %9.4f %9.4f %9.6f %9.4f %9.4f\n", t.interval_s, t.count,
                 t.rms_x_m, t.rms_y_m, t.rms_yaw_rad, t.rms_x_m / t.interval_s,
                 kDegPerRad * t.rms_yaw_rad / t.interval_s);
  }
}

void print_segment(std::FILE* file, const std::string& source, const SegmentErrors& errors) {
  std::fprintf(file, "# %-15s %6s %8zu %8.3f %8.3f %8.3f %8.2f %8zu %8.2f %8.2f %8.2f %8.2f\n",
               source.c_str(), to_text(errors.length).c_str(), errors.segments, errors.rmse.x(),
               errors.rmse.y(), kDegPerRad * errors.rmse.z(), errors.position_percent,
               errors.chains, errors.anees, errors.nees.x(), errors.nees.y(), errors.nees.z());
}

}  // namespace

void print_segments(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                    const TruthNoise& noise) {
  const std::string note = noise.note();
  std::fprintf(
      file,
      "# pose after a distance or a time. Errors after a time: over every window, begun 0.5 s "
      "apart (of the vehicle's\n# state: of the poses since the start). ANEES: of estimates "
      "chained as independent, from every anchor, the only\n# time without covariance, to the row "
      "nearest to that time (of motions: begun 0.5 s apart)%s%s\n",
      note.empty() ? "" : "; ", note.c_str());
  std::fprintf(file, "# %-15s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "source", "after",
               "segments", "rmse_x_m", "rmse_y_m", "yaw_deg", "%_of_way", "chains", "anees",
               "nees_x", "nees_y", "nees_yaw");
  for (const SourceEvaluation& source : sources) {
    for (const SegmentErrors& errors : source.segments) {
      if (errors.segments + errors.chains != 0) {
        print_segment(file, source.source, errors);
      }
    }
  }
}

void print_wheels(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                  const WheelReference& wheels, const std::vector<TruthAgainstWheels>& truth) {
  std::fprintf(file,
               "# against the wheels (nees_wheels includes their std %g m/s, %g rad/s); NEES "
               "against truth = estimate + truth + cross\n",
               wheels.std().speed_mps, wheels.std().yaw_rate_radps);
  std::fprintf(file, "# %-15s %-10s %6s %9s %9s %9s %9s %9s %9s %9s %9s\n", "source", "axis", "n",
               "nees_whls", "estimate", "truth", "cross", "nees_trth", "rms_est", "rms_truth",
               "rms_e-t");
  for (const SourceEvaluation& source : sources) {
    if (source.wheels) {
      print_axis(file, source.source, "x m/s", source.wheels->x, 1.0);
      print_axis(file, source.source, "yaw deg/s", source.wheels->yaw, kDegPerRad);
    }
    if (source.twist) {
      print_twist(file, source.source, *source.twist);
    }
  }
  print_truth(file, truth);
}

}  // namespace cremed
