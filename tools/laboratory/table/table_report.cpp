// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/table_report.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/report_file.hpp"

namespace cremed {
namespace {

constexpr const char* kNotes =
    "# RMSE counts x and y; ANEES is over the estimated states (x, yaw; PSR and ICP: x, y, yaw);\n"
    "# low, high: 95 % interval of the ANEES of consistent estimators; bound: least squares with\n"
    "# known correspondences.\n";

/// Column titles: text and, for the row of groups, the start of a group.
std::string header() {
  std::array<char, 320> buffer{};
  std::snprintf(buffer.data(), buffer.size(),
                "# %-28s %-40s %-49s| %-17s| %s\n"
                "%-9s %-12s %7s %8s %8s %8s %8s %8s %6s %7s %8s %9s %7s %7s |%6s %5s %5s |%8s %6s "
                "%6s\n",
                "", "this run", "", "paper", "bound", "# problem", "method", "pairs", "rmse_m",
                "rmse_deg", "anees", "low", "high", "iter", "ms_pair", "left_out", "ambiguous",
                "no_conv", "nees>25", "m", "deg", "anees", "m", "deg", "anees");
  return buffer.data();
}

std::string text(double value, int width, int decimals, std::string_view unknown) {
  std::array<char, 48> buffer{};
  if (std::isnan(value)) {
    std::snprintf(buffer.data(), buffer.size(), "%*s", width, unknown.data());
  } else {
    std::snprintf(buffer.data(), buffer.size(), "%*.*f", width, decimals, value);
  }
  return buffer.data();
}

/// A cell with a leading space. Large figures, of methods that fail, need no decimals.
std::string cell(double value, int width, int decimals) {
  return text(value, width + 1, value >= 1000.0 ? 0 : decimals, "-");
}

std::string figures(const Figures& f, int width_m, int decimals_m, int width, int decimals) {
  return cell(f.rmse_m, width_m, decimals_m)
      .append(cell(f.rmse_deg, width, decimals))
      .append(cell(f.anees, width, decimals));
}

std::string csv(const Figures& f) {
  return text(f.rmse_m, 0, 6, "")
      .append(",")
      .append(text(f.rmse_deg, 0, 5, ""))
      .append(",")
      .append(text(f.anees, 0, 5, ""));
}

void print_row(std::FILE* stream, const TableRow& row) {
  std::fprintf(stream, "%-9s %-12s", row.problem.data(), row.method.data());
  const std::string ours = cell(row.ours.rmse_m, 8, 5) + cell(row.ours.rmse_deg, 8, 4) +
                           cell(row.ours.anees, 8, 3) + cell(row.consistent.low, 8, 3) +
                           cell(row.consistent.high, 8, 3);
  std::fprintf(stream, " %7zu%s %6.1f %7.3f %8zu %9zu %7zu %7zu |%s |%s\n", row.count, ours.c_str(),
               row.iterations, row.milliseconds, row.left_out, row.ambiguous, row.no_convergence,
               row.gross, figures(row.paper, 5, 3, 5, 2).c_str(),
               figures(row.bound, 7, 5, 6, 3).c_str());
}

constexpr const char* kRealNotes =
    "# Front radar, from scan to scan. MSM(paper), MSM-D(paper): estimator and selection of "
    "targets\n"
    "# as in the paper, without and with Doppler; cremed: as configured. ANEES is over x and yaw;\n"
    "# 95 % of consistent estimators have it between low and high. Robot: SIMULATED, three drives\n"
    "# (cremed-simulate --scenario campus, Bosch GPR); the paper's recording is not public.\n";

void print_row(std::FILE* stream, const RealRow& row) {
  const std::string ours = cell(row.ours.rmse_m, 8, 5) + cell(row.ours.rmse_deg, 8, 4) +
                           cell(row.ours.anees, 8, 3) + cell(row.consistent.low, 8, 3) +
                           cell(row.consistent.high, 8, 3);
  std::fprintf(stream, "%-9s %-12s %7zu%s %8zu |%s |%s\n", row.problem.data(), row.method.data(),
               row.count, ours.c_str(), row.left_out, figures(row.paper, 6, 4, 6, 3).c_str(),
               figures(row.paper_850, 6, 4, 6, 3).c_str());
}

void print_row(std::FILE* stream, const RealTable::Odometry& row) {
  const SegmentErrors& errors = row.errors;
  std::fprintf(stream, "%-9s %-12s %8zu%s%s%s%s\n", row.problem.data(),
               ("after " + to_text(errors.length)).c_str(), errors.segments,
               cell(std::hypot(errors.rmse.x(), errors.rmse.y()), 8, 4).c_str(),
               cell(errors.rmse.z() * kDegPerRad, 8, 3).c_str(), cell(errors.anees, 8, 3).c_str(),
               cell(errors.position_percent, 8, 2).c_str());
}

}  // namespace

void print_real_table(std::FILE* stream, const RealTable& table) {
  std::fputs(kRealNotes, stream);
  if (!table.note.empty()) {
    std::fprintf(stream, "# NuSc: %s.\n", table.note.c_str());
  }
  std::fprintf(stream,
               "# %-20s %-50s %8s | paper (NuSc: mini) | paper (NuSc: trainval)\n"
               "# problem method      pairs   rmse_m rmse_deg    anees      low     high left_out |"
               "     m    deg  anees |     m    deg  anees\n",
               "", (std::to_string(table.drives) + " drives in the folder").c_str(), "");
  for (const RealRow& row : table.rows) {
    print_row(stream, row);
  }
  std::fprintf(
      stream,
      "# Odometry of all radars: error of the pose after that time over every window, begun 0.5 s\n"
      "# apart; ANEES of the poses chained from every anchor.\n"
      "# problem time        segments   rmse_m rmse_deg    anees  percent_of_way\n");
  for (const RealTable::Odometry& row : table.odometry) {
    print_row(stream, row);
  }
}

void print_table(std::FILE* stream, const std::vector<TableRow>& rows) {
  std::fputs(kNotes, stream);
  std::fputs(header().c_str(), stream);
  for (const TableRow& row : rows) {
    print_row(stream, row);
  }
}

void write_table_csv(const std::string& path, const std::vector<TableRow>& rows) {
  ReportFile file(path);
  std::fputs(
      "problem,method,dof,pairs,rmse_m,rmse_deg,anees,anees_low,anees_high,paper_m,paper_deg,"
      "paper_anees,bound_m,bound_deg,bound_anees\n",
      file.stream());
  for (const TableRow& row : rows) {
    std::fprintf(file.stream(), "%s,%s,%d,%zu,%s,%.5f,%.5f,%s,%s\n", row.problem.data(),
                 row.method.data(), row.degrees_of_freedom, row.count, csv(row.ours).c_str(),
                 row.consistent.low, row.consistent.high, csv(row.paper).c_str(),
                 csv(row.bound).c_str());
  }
  file.close();
}

void write_nees_csv(const std::string& path, const std::vector<TableRow>& rows) {
  ReportFile file(path);
  std::fputs("problem,method,dof,low,count\n", file.stream());
  for (const TableRow& row : rows) {
    for (std::size_t bin = 0; bin < NeesHistogram::kBins; ++bin) {
      std::fprintf(file.stream(), "%s,%s,%d,%.2f,%zu\n", row.problem.data(), row.method.data(),
                   row.degrees_of_freedom, NeesHistogram::kBinWidth * static_cast<double>(bin),
                   row.nees.counts()[bin]);
    }
  }
  file.close();
}

}  // namespace cremed
