// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/table_report.hpp"

#include <cmath>
#include <string_view>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/report_file.hpp"

namespace cremed {
namespace {

constexpr const char* kNotes =
    "# RMSE counts x and y; ANEES is over the estimated states (x, yaw; PSR and ICP: x, y, yaw);\n"
    "# low, high: 95 % interval of the ANEES of consistent estimators; bound: least squares with\n"
    "# known correspondences.\n"
    "#                              this run                                                   "
    "                               | paper            | bound\n"
    "# problem method         pairs   rmse_m rmse_deg    anees      low     high   iter "
    "ms_pair left_out ambiguous no_conv nees>25 |     m   deg anees |       m    deg  anees\n";

std::string text(double value, int width, int decimals, std::string_view unknown) {
  return std::isnan(value) ? fmt::format("{:>{}}", unknown, width)
                           : fmt::format("{:{}.{}f}", value, width, decimals);
}

/// A cell with a leading space. Large figures, of methods that fail, need no decimals.
std::string cell(double value, int width, int decimals) {
  return text(value, width + 1, value >= 1000.0 ? 0 : decimals, "-");
}

std::string figures(const Figures& f, int width_m, int decimals_m, int width, int decimals) {
  return cell(f.rmse_m, width_m, decimals_m) + cell(f.rmse_deg, width, decimals) +
         cell(f.anees, width, decimals);
}

std::string csv(const Figures& f) {
  return fmt::format("{},{},{}", text(f.rmse_m, 0, 6, ""), text(f.rmse_deg, 0, 5, ""),
                     text(f.anees, 0, 5, ""));
}

/// This run's, and the interval of the ANEES of consistent estimators.
std::string ours(const Credibility& of) {
  const Interval consistent = consistent_anees(of);
  return cell(of.rmse_m(), 8, 5) + cell(of.rmse_deg(), 8, 4) + cell(of.anees(), 8, 3) +
         cell(consistent.low, 8, 3) + cell(consistent.high, 8, 3);
}

void print_row(std::FILE* stream, const TableRow& row) {
  fmt::print(stream, "{:<9} {:<12}", row.problem, row.method);
  fmt::print(stream, " {:7}{} {:>6.1f} {:>7.3f} {:8} {:9} {:7} {:7} |{} |{}\n",
             row.credibility.count(), ours(row.credibility), row.iterations, 1e-3 * row.solve_us,
             row.left_out, row.ambiguous, row.no_convergence, row.gross,
             figures(row.paper, 5, 3, 5, 2), figures(row.bound, 7, 5, 6, 3));
}

constexpr const char* kRealNotes =
    "# Front radar, from scan to scan. MSM(paper), MSM-D(paper): estimator and selection of "
    "targets\n"
    "# as in the paper, without and with Doppler; cremed: as configured. ANEES is over x and yaw;\n"
    "# 95 % of consistent estimators have it between low and high. Robot: SIMULATED, three drives\n"
    "# (cremed-simulate --scenario campus, Bosch GPR); the paper's recording is not public.\n";

void print_row(std::FILE* stream, const RealRow& row) {
  fmt::print(stream, "{:<9} {:<12} {:7}{} {:8} |{} |{}\n", row.problem, row.method,
             row.credibility.count(), ours(row.credibility), row.left_out,
             figures(row.paper, 6, 4, 6, 3), figures(row.paper_850, 6, 4, 6, 3));
}

void print_row(std::FILE* stream, const RealTable::Odometry& row) {
  const SegmentErrors& errors = row.errors;
  fmt::print(stream, "{:<9} {:<12} {:8}{}{}{}{}\n", row.problem, "after " + to_text(errors.length),
             errors.segments, cell(std::hypot(errors.rmse.x(), errors.rmse.y()), 8, 4),
             cell(errors.rmse.z() * kDegPerRad, 8, 3), cell(errors.anees, 8, 3),
             cell(errors.position_percent, 8, 2));
}

}  // namespace

void print_real_table(std::FILE* stream, const RealTable& table) {
  std::fputs(kRealNotes, stream);
  if (!table.note.empty()) {
    fmt::print(stream, "# NuSc: {}.\n", table.note);
  }
  fmt::print(stream,
             "# {:<20} {:<50} {:>8} | paper (NuSc: mini) | paper (NuSc: trainval)\n"
             "# problem method      pairs   rmse_m rmse_deg    anees      low     high left_out |"
             "     m    deg  anees |     m    deg  anees\n",
             "", (std::to_string(table.drives) + " drives in the folder"), "");
  for (const RealRow& row : table.rows) {
    print_row(stream, row);
  }
  fmt::print(
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
  for (const TableRow& row : rows) {
    print_row(stream, row);
  }
}

void write_table_csv(const std::string& path, const std::vector<TableRow>& rows) {
  ReportFile file(path);
  file.print(
      "problem,method,dof,pairs,rmse_m,rmse_deg,anees,anees_low,anees_high,paper_m,paper_deg,"
      "paper_anees,bound_m,bound_deg,bound_anees\n");
  for (const TableRow& row : rows) {
    const Credibility& c = row.credibility;
    const Interval consistent = consistent_anees(c);
    file.print("{},{},{},{},{},{:.5f},{:.5f},{},{}\n", row.problem, row.method,
               c.degrees_of_freedom(), c.count(), csv(figures_of(c)), consistent.low,
               consistent.high, csv(row.paper), csv(row.bound));
  }
  file.close();
}

void write_nees_csv(const std::string& path, const std::vector<TableRow>& rows) {
  ReportFile file(path);
  file.print("problem,method,dof,low,count\n");
  for (const TableRow& row : rows) {
    for (std::size_t bin = 0; bin < NeesHistogram::kBins; ++bin) {
      file.print("{},{},{},{:.2f},{}\n", row.problem, row.method,
                 row.credibility.degrees_of_freedom(),
                 NeesHistogram::kBinWidth * static_cast<double>(bin), row.nees.counts()[bin]);
    }
  }
  file.close();
}

}  // namespace cremed
