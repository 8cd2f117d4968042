// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/other_trajectory.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "daemon/process/whole_number.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/input_file.hpp"

namespace cremed {
namespace {

constexpr std::size_t kTumNumbers = 8;
constexpr std::size_t kKittiNumbers = 12;

/// Stamps later than the year 3000, or earlier than 1970, are no seconds.
constexpr double kLatestS = 3.3e10;

struct TimedPose {
  std::int64_t utime_us = 0;
  Pose2 pose;
};

std::runtime_error bad_line(std::size_t line, const std::string& what) {
  return std::runtime_error("line " + std::to_string(line) + ": " + what);
}

double number(const std::string& word, std::size_t line) {
  const auto value = whole_number<double>(word);
  if (!value || !std::isfinite(*value)) {
    throw bad_line(line, "'" + word + "' is no number");
  }
  return *value;
}

/// The numbers of each line that has some; "#" begins a comment.
std::vector<std::vector<double>> read_numbers(std::istream& input, std::size_t count) {
  std::vector<std::vector<double>> rows;
  std::size_t line = 0;
  for (std::string text; std::getline(input, text);) {
    ++line;
    std::istringstream words(text.substr(0, text.find('#')));
    std::vector<double> row;
    for (std::string word; words >> word;) {
      row.push_back(number(word, line));
    }
    if (!row.empty() && row.size() != count) {
      throw bad_line(line, std::to_string(row.size()) + " numbers where " + std::to_string(count) +
                               " are expected");
    }
    if (!row.empty()) {
      rows.push_back(row);
    }
  }
  return rows;
}

std::int64_t utime_us(double seconds) {
  if (seconds < 0.0 || seconds > kLatestS) {
    throw std::runtime_error(std::to_string(seconds) + " is no time in seconds");
  }
  return std::llround(1e6 * seconds);
}

TimedPose from_tum(const std::vector<double>& row) {
  const double x = row[4];
  const double y = row[5];
  const double z = row[6];
  const double w = row[7];
  const double yaw_rad = std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
  return {utime_us(row[0]), {row[1], row[2], yaw_rad}};
}

/// Forward is the camera's z, left its -x.
TimedPose from_kitti(const std::vector<double>& row, double seconds) {
  const auto at = [&](std::size_t i, std::size_t j) { return row[4 * i + j]; };
  return {utime_us(seconds), {at(2, 3), -at(0, 3), std::atan2(-at(0, 2), at(2, 2))}};
}

std::vector<TimedPose> read_tum(const std::string& path) {
  return with_input(path, [](std::istream& input) {
    std::vector<TimedPose> poses;
    for (const auto& row : read_numbers(input, kTumNumbers)) {
      poses.push_back(from_tum(row));
    }
    return poses;
  });
}

std::vector<TimedPose> read_kitti(const std::string& path, const std::string& times_path) {
  const auto read = [](const std::string& file, std::size_t count) {
    return with_input(file, [&](std::istream& input) { return read_numbers(input, count); });
  };
  const auto rows = read(path, kKittiNumbers);
  const auto times = read(times_path, 1);
  if (rows.size() != times.size()) {
    throw std::runtime_error(times_path + ": " + std::to_string(times.size()) + " times for " +
                             std::to_string(rows.size()) + " poses");
  }
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    poses.push_back(from_kitti(rows[i], times[i].front()));
  }
  return poses;
}

}  // namespace

RecordedOdometry read_other_trajectory(const std::string& files, const TimeSpan& drive) {
  const std::size_t comma = files.find(',');
  const std::string path = files.substr(0, comma);
  const std::vector<TimedPose> poses =
      comma == std::string::npos ? read_tum(path) : read_kitti(path, files.substr(comma + 1));
  if (poses.size() < 2) {
    throw std::runtime_error(path + ": fewer than two poses");
  }
  std::vector<RowTime> rows;
  std::vector<std::int64_t> utimes_us;
  for (const TimedPose& pose : poses) {
    rows.push_back({pose.utime_us, true});
    utimes_us.push_back(pose.utime_us);
  }
  const std::int64_t longest_us = longest_step_us(utimes_us);
  RecordedOdometry odometry{std::filesystem::path(path).stem(), {}, 0};
  const Eigen::Matrix3d unknown =
      Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const TimedPose& from = poses[i - 1];
    const TimedPose& to = poses[i];
    if (to.utime_us <= from.utime_us) {
      throw std::runtime_error(path + ": pose " + std::to_string(i + 1) +
                               ": its time is not later than that before it");
    }
    if (to.utime_us - from.utime_us <= longest_us) {
      odometry.estimates.push_back(
          {from.utime_us, to.utime_us, motion_between(from.pose, to.pose), unknown});
    }
  }
  odometry.availability = availability(rows, drive);
  return odometry;
}

}  // namespace cremed
