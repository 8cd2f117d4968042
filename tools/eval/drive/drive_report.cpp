// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_report.hpp"

#include <cmath>
#include <map>
#include <string>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/output/tum_writer.hpp"
#include "tools/eval/chi_square.hpp"
#include "tools/eval/drive/trajectory_error.hpp"
#include "tools/eval/report_file.hpp"

namespace cremed {
namespace {

std::size_t gaps(const SourceEvaluation& source) {
  return source.path.empty() ? 0 : source.path.back().gaps;
}

double seconds(std::int64_t utime_us, const TrueTrajectory& truth) {
  return static_cast<double>(utime_us - truth.utime_us().front()) * 1e-6;
}

std::string text(std::size_t count) { return std::to_string(count); }

/// "-" if there is no segment.
std::string text(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// A row of the drift table: `cell` of each length, then of all.
template <typename Cell>
void print_drift_row(std::FILE* file, const SourceEvaluation& source, const char* what, Cell cell) {
  fmt::print(file, "# {:<15} {:<8}", source.source, what);
  for (const PathDrift& drift : source.drift) {
    fmt::print(file, " {:>7}", cell(drift));
  }
  fmt::print(file, " {:>7}\n", cell(mean_drift(source.drift)));
}

void print_drift(std::FILE* file, const SourceEvaluation& source) {
  const auto row = [&](const char* what, auto cell) { print_drift_row(file, source, what, cell); };
  row("%", [](const PathDrift& d) { return text(d.translation_percent, 2); });
  row("deg/m", [](const PathDrift& d) { return text(d.rotation_deg_per_m, 4); });
  row("segments", [](const PathDrift& d) { return text(d.segments); });
  if (gaps(source) != 0) {
    row("left out", [](const PathDrift& d) { return text(d.across_gaps); });
    fmt::print(file, "# {:<15} omitted: segments across a gap without estimate; gaps: {}\n",
               source.source, gaps(source));
  }
}

/// One axis' row; `unit` converts metres or radians.
void print_axis(std::FILE* file, const std::string& source, const char* name,
                const AxisAgainstWheels& axis, double unit) {
  fmt::print(file,
             "# {:<15} {:<10} {:6} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.4f} {:>9.4f} "
             "{:>9.4f}\n",
             source, name, axis.count, axis.nees, axis.nees_estimate, axis.nees_truth,
             axis.nees_cross, axis.nees_against_truth(), unit * axis.rms_estimate_per_s,
             unit * axis.rms_truth_per_s, unit * axis.rms_both_per_s);
}

void print_twist(std::FILE* file, const std::string& source, const TwistAgainstWheels& twist) {
  const auto row = [&](const char* name, double nees, double rms) {
    fmt::print(file, "# {:<15} {:<10} {:6} {:>9.3f} {:>39} {:>9.4f}\n", source, name, twist.count,
               nees, "", rms);
  };
  row("vx m/s", twist.nees_speed, twist.rms_speed_mps);
  row("w deg/s", twist.nees_yaw_rate, kDegPerRad * twist.rms_yaw_rate_radps);
}

void print_truth(std::FILE* file, const std::vector<TruthAgainstWheels>& truth) {
  fmt::print(
      file,
      "# truth against the wheels over intervals of one length, RMS; y: upper bound, includes "
      "slip in bends\n# {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      "s", "intervals", "x_m", "y_m", "yaw_rad", "x_m/s", "yaw_deg/s");
  for (const TruthAgainstWheels& t : truth) {
    fmt::print(file, "# {:>6.3f} {:9} {:>9.4f} {:>9.4f} {:>9.6f} {:>9.4f} {:>9.4f}\n", t.interval_s,
               t.count, t.rms_x_m, t.rms_y_m, t.rms_yaw_rad, t.rms_x_m / t.interval_s,
               kDegPerRad * t.rms_yaw_rad / t.interval_s);
  }
}

void print_segment(std::FILE* file, const std::string& source, const SegmentErrors& errors) {
  fmt::print(file, "# {:<15} {:>6} {:8} {:>8} {:>8} {:>8} {:>8} {:8} {:>8} {:>8} {:>8} {:>8}\n",
             source, to_text(errors.length), errors.segments, text(errors.rmse.x(), 3),
             text(errors.rmse.y(), 3), text(kDegPerRad * errors.rmse.z(), 3),
             text(errors.position_percent, 2), errors.chains, text(errors.anees, 2),
             text(errors.nees.x(), 2), text(errors.nees.y(), 2), text(errors.nees.z(), 2));
}

}  // namespace

void print_drive(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                 const TruthNoise& noise) {
  const std::string note = noise.note();
  fmt::print(
      file,
      "# n estimates against truth: RMS errors; anees: mean of (error / sigma)^2, 1 if the "
      "covariance is credible,\n# less if it is too large; share of errors within 1, 2, 3 sigma, "
      "of a Gaussian 0.683, 0.954, 0.997{}{}\n",
      note.empty() ? "" : "; ", note);
  fmt::print(file, "{:<16} {}\n", "# source", kCredibilityColumns);
  for (const SourceEvaluation& source : sources) {
    fmt::print(file, "{:<16} {}\n", source.source, to_line(source.credibility));
  }
  for (const SourceEvaluation& source : sources) {
    fmt::print(file, "# {:<15} a usable estimate for {} % of the drive\n", source.source,
               text(source.availability.percent, 1));
  }
  for (const SourceEvaluation& source : sources) {
    const TrajectoryError error = trajectory_error(source.path);
    fmt::print(file,
               "# {:<15} distance of its path from truth, RMS: {} m where it begins at truth, {} m "
               "aligned with all of it\n",
               source.source, text(error.from_begin_m, 3), text(error.aligned_m, 3));
  }
  fmt::print(file, "# drift over segments of the true path, mean of all segments (KITTI)\n# {:<24}",
             "");
  for (const double length_m : kDriftLengthsM) {
    fmt::print(file, " {:>5.0f} m", length_m);
  }
  fmt::print(file, "     all\n");
  for (const SourceEvaluation& source : sources) {
    print_drift(file, source);
  }
}

void write_truth_csv(const std::string& path, const TrueTrajectory& truth) {
  ReportFile file(path);
  file.print("x_m,y_m\n");
  for (const Pose2& pose : truth.poses()) {
    file.print("{:.4f},{:.4f}\n", pose.x_m - truth.poses().front().x_m,
               pose.y_m - truth.poses().front().y_m);
  }
  file.close();
}

void write_sources_csv(const std::string& path, const std::vector<SourceEvaluation>& sources) {
  ReportFile file(path);
  file.print(
      "source,dof,estimates,without_estimate,availability_percent,gaps,rmse_m,rmse_deg,"
      "anees,anees_low,"
      "anees_high,nees_low,nees_high,outside_x,outside_y,outside_yaw,segments,across_gaps,"
      "translation_percent,rotation_deg_per_m,windows_10s,yaw_deg_10s,percent_10s,"
      "anees_10s\n");
  for (const SourceEvaluation& source : sources) {
    const Credibility& c = source.credibility;
    const int dof = source.degrees_of_freedom;
    const Interval anees = anees_interval(c.count(), dof, 0.95);
    const Interval nees = anees_interval(1, dof, 0.95);
    const PathDrift drift = mean_drift(source.drift);
    file.print("{},{},{},{},{:.3f},{},", source.source, dof, c.count(), source.without_estimate,
               source.availability.percent, gaps(source));
    file.print("{:.5f},{:.5f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},", c.rmse_m(), c.rmse_deg(),
               c.anees(), anees.low, anees.high, nees.low, nees.high);
    file.print("{:.4f},{:.4f},{:.4f},", 1.0 - c.coverage(0, 3), 1.0 - c.coverage(1, 3),
               1.0 - c.coverage(2, 3));
    file.print("{},{},{:.5g},{:.5g},", drift.segments, drift.across_gaps, drift.translation_percent,
               drift.rotation_deg_per_m);
    const SegmentErrors& late = after_time(source.segments, 10.0);
    file.print("{},{:.5g},{:.5g},{:.5g}\n", late.segments, kDegPerRad * late.rmse.z(),
               late.position_percent, late.anees);
  }
  file.close();
}

void write_errors_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                      const TrueTrajectory& truth) {
  ReportFile file(path);
  file.print(
      "source,time_s,x_m,y_m,yaw_deg,sigma_x_m,sigma_y_m,sigma_yaw_deg,nees,mean_nees,"
      "mean_low,mean_high,speed_mps,true_speed_mps,yaw_rate_degps,true_yaw_rate_degps\n");
  for (const SourceEvaluation& source : sources) {
    for (std::size_t i = 0; i < source.errors.size(); ++i) {
      const EstimateError& e = source.errors[i];
      const RunningNees& running = source.mean_nees[i];
      file.print("{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.5g},{:.5g},{:.5g},{:.5g},",
                 source.source, seconds(e.utime_us, truth), e.error.x(), e.error.y(),
                 kDegPerRad * e.error.z(), e.sigma.x(), e.sigma.y(), kDegPerRad * e.sigma.z(),
                 e.nees, running.mean, running.interval.low, running.interval.high);
      file.print("{:.4f},{:.4f},{:.4f},{:.4f}\n", e.estimate.forward_mps, e.truth.forward_mps,
                 kDegPerRad * e.estimate.yaw_radps, kDegPerRad * e.truth.yaw_radps);
    }
  }
  file.close();
}

void write_path_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                    const TrueTrajectory& truth) {
  ReportFile file(path);
  file.print("source,x_m,y_m,gaps\n");
  for (const SourceEvaluation& source : sources) {
    for (const PathPose& pose : source.path) {
      file.print("{},{:.4f},{:.4f},{}\n", source.source,
                 pose.estimate.x_m - truth.poses().front().x_m,
                 pose.estimate.y_m - truth.poses().front().y_m, pose.gaps);
    }
  }
  file.close();
}

void write_drift_csv(const std::string& path, const std::vector<SourceEvaluation>& sources) {
  ReportFile file(path);
  file.print("source,length_m,segments,across_gaps,translation_percent,rotation_deg_per_m\n");
  for (const SourceEvaluation& source : sources) {
    for (const PathDrift& drift : source.drift) {
      file.print("{},{:g},{},{},{:.5g},{:.5g}\n", source.source, drift.length_m, drift.segments,
                 drift.across_gaps, drift.translation_percent, drift.rotation_deg_per_m);
    }
  }
  file.close();
}

void write_truth_tum(const std::string& path, const std::vector<SourceEvaluation>& sources) {
  std::map<std::int64_t, Pose2> poses;
  for (const SourceEvaluation& source : sources) {
    for (const PathPose& pose : source.path) {
      poses.emplace(pose.utime_us, pose.truth);
    }
  }
  ReportFile file(path);
  for (const auto& [utime_us, pose] : poses) {
    file.print("{}", tum_line(utime_us, pose).view());
  }
  file.close();
}

void print_segments(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                    const TruthNoise& noise) {
  const std::string note = noise.note();
  fmt::print(
      file,
      "# pose after a distance or a time. Errors after a time: over every window, begun 0.5 s "
      "apart (of the vehicle's\n# state: of the poses since the start). ANEES: of estimates "
      "chained as independent, from every anchor, the only\n# time without covariance, to the row "
      "nearest to that time (of motions: begun 0.5 s apart){}{}\n",
      note.empty() ? "" : "; ", note);
  fmt::print(file, "# {:<15} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
             "source", "after", "segments", "rmse_x_m", "rmse_y_m", "yaw_deg", "%_of_way", "chains",
             "anees", "nees_x", "nees_y", "nees_yaw");
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
  fmt::print(file,
             "# against the wheels (nees_wheels includes their std {:g} m/s, {:g} rad/s); NEES "
             "against truth = estimate + truth + cross\n",
             wheels.std().speed_mps, wheels.std().yaw_rate_radps);
  fmt::print(file, "# {:<15} {:<10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
             "source", "axis", "n", "nees_whls", "estimate", "truth", "cross", "nees_trth",
             "rms_est", "rms_truth", "rms_e-t");
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
