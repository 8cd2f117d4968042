// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fuses cremed's odometry with a gyro: yaw since the start, and the gyro's bias with its sigma.
//     fuse_gyro GYRO.csv [LCM URL]      GYRO.csv: utime,yaw_rate_radps
// Neighbouring messages share errors (the body's for 0.3 s, the mounts' permanently): used as one
// measurement each, they would make the filter overconfident. Errors from anchor to anchor
// (odometry.anchor_period_s) count as independent for a minute: one measurement per anchor.
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include <cremed/odometry_t.hpp>
#include <lcm/lcm-cpp.hpp>

constexpr double kGyroNoise = 0.002;    // rad/sqrt(s)
constexpr double kStartBiasStd = 0.02;  // rad/s

/// State: yaw and bias; a Kalman filter of the turn from anchor to anchor.
struct YawFilter {
  double yaw_rad = 0.0;
  double bias_radps = 0.0;
  double bias_variance = kStartBiasStd * kStartBiasStd;

  void add(double seconds, double gyro_turn_rad, double odometry_turn_rad, double variance) {
    const double turn_rad = gyro_turn_rad - bias_radps * seconds;
    const double turn_variance =
        bias_variance * seconds * seconds + kGyroNoise * kGyroNoise * seconds;
    const double covariance = -bias_variance * seconds;  // of turn and bias
    const double innovation = (odometry_turn_rad - turn_rad) / (turn_variance + variance);
    yaw_rad += turn_rad + turn_variance * innovation;
    bias_radps += covariance * innovation;
    bias_variance -= covariance * covariance / (turn_variance + variance);
  }
};

/// The angle turned, from samples in a file; replace it with the vehicle's gyro.
struct Gyro {
  std::map<std::int64_t, double> angles_rad;

  explicit Gyro(const char* path) {
    std::ifstream file(path);
    std::string header;
    std::getline(file, header);
    std::int64_t utime = 0;
    std::int64_t before = 0;
    double rate_radps = 0.0;
    double angle_rad = 0.0;
    for (char comma = ' '; file >> utime >> comma >> rate_radps; before = utime) {
      angle_rad += before == 0 ? 0.0 : rate_radps * static_cast<double>(utime - before) * 1e-6;
      angles_rad[utime] = angle_rad;
    }
  }
  double angle_at(std::int64_t utime) const {
    const auto found = angles_rad.upper_bound(utime);
    return found == angles_rad.end() ? angles_rad.rbegin()->second : found->second;
  }
  double turn_rad(std::int64_t begin, std::int64_t end) const {
    return angle_at(end) - angle_at(begin);
  }
};

struct Subscriber {
  Gyro gyro;
  YawFilter estimate;
  cremed::odometry_t last{};
  bool was_set_back = false;  // The clock: nothing spans that.

  void on_odometry(const lcm::ReceiveBuffer*, const std::string&,
                   const cremed::odometry_t* message) {
    if (message->status > cremed::odometry_t::STATUS_STANDING_STILL) {
      return;
    }
    was_set_back = last.utime != 0 && message->utime < last.utime;
    if (was_set_back) {
      return;
    }
    // `last` is the last message of its anchor.
    if (last.utime != 0 && message->utime_anchor != last.utime_anchor) {
      estimate.add(static_cast<double>(last.utime - last.utime_anchor) * 1e-6,
                   gyro.turn_rad(last.utime_anchor, last.utime), last.yaw_in_anchor_frame_rad,
                   last.covariance_x_y_yaw_in_anchor_frame_m_rad[8]);
      // Messages were lost, or the radars were silent.
      const double missing_s = static_cast<double>(message->utime_anchor - last.utime) * 1e-6;
      estimate.yaw_rad +=
          gyro.turn_rad(last.utime, message->utime_anchor) - estimate.bias_radps * missing_s;
      std::printf("%" PRId64 " yaw %.5f rad, bias %.5f +- %.5f rad/s\n", message->utime_anchor,
                  estimate.yaw_rad, estimate.bias_radps, std::sqrt(estimate.bias_variance));
      std::fflush(stdout);
    }
    last = *message;
  }
};

int main(int argc, char** argv) {
  lcm::LCM lcm(argc > 2 ? argv[2] : "");  // "": LCM's default; "file://LOG?speed=0": a recording.
  if (argc < 2 || !lcm.good()) {
    std::fputs("usage: fuse_gyro GYRO.csv [LCM URL]\n", stderr);
    return 2;
  }
  Subscriber subscriber{Gyro(argv[1]), {}, {}};
  if (subscriber.gyro.angles_rad.empty()) {
    std::fprintf(stderr, "fuse_gyro: %s: no rows of utime,yaw_rate_radps\n", argv[1]);
    return 1;
  }
  lcm.subscribe("CREMED_ODOMETRY", &Subscriber::on_odometry, &subscriber);
  while (lcm.handle() == 0) {
    if (subscriber.was_set_back) {
      std::fputs("fuse_gyro: the clock was set back: nothing spans that; begin anew\n", stderr);
      return 1;
    }
  }
  return 0;
}
