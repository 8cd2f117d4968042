// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_report.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/output/text_line.hpp"
#include "daemon/output/tum_writer.hpp"
#include "tools/eval/chi_square.hpp"
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
  return std::isnan(value) ? "-" : std::string(TextLine().fixed(value, decimals).view());
}

/// A row of the drift table: `cell` of each length, then of all.
template <typename Cell>
void print_drift_row(std::FILE* file, const SourceEvaluation& source, const char* what, Cell cell) {
  std::fprintf(file, "# %-15s %-8s", source.source.c_str(), what);
  for (const PathDrift& drift : source.drift) {
    std::fprintf(file, " %7s", cell(drift).c_str());
  }
  std::fprintf(file, " %7s\n", cell(mean_drift(source.drift)).c_str());
}

void print_drift(std::FILE* file, const SourceEvaluation& source) {
  const auto row = [&](const char* what, auto cell) { print_drift_row(file, source, what, cell); };
  row("%", [](const PathDrift& d) { return text(d.translation_percent, 2); });
  row("deg/m", [](const PathDrift& d) { return text(d.rotation_deg_per_m, 4); });
  row("segments", [](const PathDrift& d) { return text(d.segments); });
  if (gaps(source) != 0) {
    row("left out", [](const PathDrift& d) { return text(d.across_gaps); });
    std::fprintf(file, "# %-15s omitted: segments across a gap without estimate; gaps: %zu\n",
                 source.source.c_str(), gaps(source));
  }
}

}  // namespace

void print_drive(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                 const TruthNoise& noise) {
  const std::string note = noise.note();
  std::fprintf(
      file,
      "# n estimates against truth: RMS errors; anees: mean of (error / sigma)^2, 1 if the "
      "covariance is credible,\n# less if it is too large; share of errors within 1, 2, 3 sigma, "
      "of a Gaussian 0.683, 0.954, 0.997%s%s\n",
      note.empty() ? "" : "; ", note.c_str());
  std::fprintf(file, "%-16s %s\n", "# source", kCredibilityColumns);
  for (const SourceEvaluation& source : sources) {
    std::fprintf(file, "%-16s %s\n", source.source.c_str(), to_line(source.credibility).c_str());
  }
  for (const SourceEvaluation& source : sources) {
    std::fprintf(file, "# %-15s a usable estimate for %s %% of the drive\n", source.source.c_str(),
                 text(source.availability.percent, 1).c_str());
  }
  std::fprintf(file,
               "# drift over segments of the true path, mean of all segments (KITTI)\n# %-24s", "");
  for (const double length_m : kDriftLengthsM) {
    std::fprintf(file, " %5.0f m", length_m);
  }
  std::fprintf(file, "     all\n");
  for (const SourceEvaluation& source : sources) {
    print_drift(file, source);
  }
}

void write_truth_csv(const std::string& path, const TrueTrajectory& truth) {
  ReportFile file(path);
  std::fprintf(file.stream(), "x_m,y_m\n");
  for (const Pose2& pose : truth.poses()) {
    std::fprintf(file.stream(), "%.4f,%.4f\n", pose.x_m - truth.poses().front().x_m,
                 pose.y_m - truth.poses().front().y_m);
  }
  file.close();
}

void write_sources_csv(const std::string& path, const std::vector<SourceEvaluation>& sources) {
  ReportFile file(path);
  std::fprintf(file.stream(),
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
    std::FILE* const out = file.stream();
    std::fprintf(out, "%s,%d,%zu,%zu,%.3f,%zu,", source.source.c_str(), dof, c.count(),
                 source.without_estimate, source.availability.percent, gaps(source));
    std::fprintf(out, "%.5f,%.5f,%.4f,%.4f,%.4f,%.4f,%.4f,", c.rmse_m(), c.rmse_deg(), c.anees(),
                 anees.low, anees.high, nees.low, nees.high);
    std::fprintf(out, "%.4f,%.4f,%.4f,", 1.0 - c.coverage(0, 3), 1.0 - c.coverage(1, 3),
                 1.0 - c.coverage(2, 3));
    std::fprintf(out, "%zu,%zu,%.5g,%.5g,", drift.segments, drift.across_gaps,
                 drift.translation_percent, drift.rotation_deg_per_m);
    const SegmentErrors& late = after_time(source.segments, 10.0);
    std::fprintf(out, "%zu,%.5g,%.5g,%.5g\n", late.segments, kDegPerRad * late.rmse.z(),
                 late.position_percent, late.anees);
  }
  file.close();
}

void write_errors_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                      const TrueTrajectory& truth) {
  ReportFile file(path);
  std::fprintf(file.stream(),
               "source,time_s,x_m,y_m,yaw_deg,sigma_x_m,sigma_y_m,sigma_yaw_deg,nees,mean_nees,"
               "mean_low,mean_high,speed_mps,true_speed_mps,yaw_rate_degps,true_yaw_rate_degps\n");
  for (const SourceEvaluation& source : sources) {
    for (std::size_t i = 0; i < source.errors.size(); ++i) {
      const EstimateError& e = source.errors[i];
      const RunningNees& running = source.mean_nees[i];
      std::fprintf(file.stream(), "%s,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.5g,%.5g,%.5g,%.5g,",
                   source.source.c_str(), seconds(e.utime_us, truth), e.error.x(), e.error.y(),
                   kDegPerRad * e.error.z(), e.sigma.x(), e.sigma.y(), kDegPerRad * e.sigma.z(),
                   e.nees, running.mean, running.interval.low, running.interval.high);
      std::fprintf(file.stream(), "%.4f,%.4f,%.4f,%.4f\n", e.estimate.forward_mps,
                   e.truth.forward_mps, kDegPerRad * e.estimate.yaw_radps,
                   kDegPerRad * e.truth.yaw_radps);
    }
  }
  file.close();
}

void write_path_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                    const TrueTrajectory& truth) {
  ReportFile file(path);
  std::fprintf(file.stream(), "source,x_m,y_m,gaps\n");
  for (const SourceEvaluation& source : sources) {
    for (const PathPose& pose : source.path) {
      std::fprintf(file.stream(), "%s,%.4f,%.4f,%zu\n", source.source.c_str(),
                   pose.estimate.x_m - truth.poses().front().x_m,
                   pose.estimate.y_m - truth.poses().front().y_m, pose.gaps);
    }
  }
  file.close();
}

void write_drift_csv(const std::string& path, const std::vector<SourceEvaluation>& sources) {
  ReportFile file(path);
  std::fprintf(file.stream(),
               "source,length_m,segments,across_gaps,translation_percent,rotation_deg_per_m\n");
  for (const SourceEvaluation& source : sources) {
    for (const PathDrift& drift : source.drift) {
      std::fprintf(file.stream(), "%s,%g,%zu,%zu,%.5g,%.5g\n", source.source.c_str(),
                   drift.length_m, drift.segments, drift.across_gaps, drift.translation_percent,
                   drift.rotation_deg_per_m);
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
    const TextLine line = tum_line(utime_us, pose);
    std::fwrite(line.view().data(), 1, line.view().size(), file.stream());
  }
  file.close();
}

}  // namespace cremed
