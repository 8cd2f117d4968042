// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/top/screen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string_view>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/process/joined.hpp"

namespace cremed {
namespace {

using Json = nlohmann::json;

/// The daemon publishes at every scan, and a status once a second.
constexpr double kSilentS = 2.0;
/// Clocks of two computers differ by less; what is older was measured in an earlier drive.
constexpr double kReplayS = 60.0;

/// A message may hold anything.
std::string ascii(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string words(const Json& name) {
  std::string text = name.is_string() ? ascii(name.get<std::string>()) : "-";
  std::ranges::replace(text, '_', ' ');
  return text;
}

bool is_number(const Json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

std::string fixed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

/// "-" if it is not known.
std::string fixed(const Json& value, int decimals) {
  return is_number(value) ? fixed(value.get<double>(), decimals) : "-";
}

std::string with_sigma(double value, double sigma, int decimals, std::string_view unit) {
  return fixed(value, decimals) + " +-" + fixed(sigma, decimals) + std::string(unit);
}

double sigma_of(const Json& variance) { return std::sqrt(std::max(variance.get<double>(), 0.0)); }

std::string date_of(std::int64_t utime) {
  const auto seconds = static_cast<std::time_t>(utime / 1'000'000);
  std::tm parts{};
  std::array<char, 32> text{};
  ::gmtime_r(&seconds, &parts);
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%SZ", &parts)};
}

/// Nothing: it is heard.
std::string silence(const Json& silent_s) {
  return is_number(silent_s) && silent_s.get<double>() >= kSilentS
             ? "silent for " + fixed(silent_s, 0) + " s"
             : std::string();
}

ScreenLine heading(const Json& state, const std::string& source) {
  const std::string begin = "cremed at " + ascii(source) + ": ";
  if (state["messages"] == 0) {
    return {begin + "no message yet", Mood::careful};
  }
  if (const std::string silent = silence(state["silent_s"]); !silent.empty()) {
    return {begin + silent, Mood::bad};
  }
  const Json& pose = state["pose"];
  if (pose.is_null()) {
    return {begin + "no odometry yet", Mood::careful};
  }
  const bool is_replay = std::abs(pose["behind_s"].get<double>()) > kReplayS;
  return {begin + (is_replay ? "replay of " : "live, ") + date_of(pose["utime"]) +
              (state["has_ended"].get<bool>() ? ", where the log ends" : ""),
          Mood::plain};
}

Mood mood_of(const Json& status) {
  if (status == "ok" || status == "standing_still") {
    return Mood::good;
  }
  return status == "initialising" || status == "predicted" ? Mood::careful : Mood::bad;
}

ScreenLine status_line(const Json& pose) {
  if (pose.is_null()) {
    return {"odometry   -", Mood::careful};
  }
  const std::string silent = silence(pose["silent_s"]);
  const std::string status = words(pose["status"]);
  return silent.empty() ? ScreenLine{"odometry   " + status, mood_of(pose["status"])}
                        : ScreenLine{"odometry   " + silent + ", then " + status, Mood::bad};
}

void add_motion(const Json& rates, std::vector<ScreenLine>& lines) {
  if (rates["vx"].empty()) {
    return;
  }
  const auto last = [&](const char* key) { return rates[key].back().get<double>(); };
  lines.push_back({fmt::format("speed      {:<29}yaw rate   {}",
                               with_sigma(last("vx"), last("vx_sigma"), 2, " m/s"),
                               with_sigma(last("yaw_rate"), last("yaw_rate_sigma"), 2, " deg/s"))});
}

void add_pose(const Json& pose, std::vector<ScreenLine>& lines) {
  if (pose.is_null()) {
    return;
  }
  const Json& covariance = pose["covariance"];  // xx, xy, yy, yaw yaw
  const double yaw_deg = kDegPerRad * std::remainder(pose["yaw"].get<double>(), 2.0 * M_PI);
  const auto value = [&](const char* key, std::size_t variance) {
    return with_sigma(pose[key].get<double>(), sigma_of(covariance[variance]), 2, " m");
  };
  lines.push_back({fmt::format("x          {:<29}y          {}", value("x", 0), value("y", 2))});
  lines.push_back({"yaw        " +
                   with_sigma(yaw_deg, kDegPerRad * sigma_of(covariance[3]), 2, " deg") +
                   "   (since the start)"});
}

std::string doubts(const Json& status) {
  std::string text =
      joined(status["doubts"], [](const Json& doubt) { return doubt.get<std::string>(); });
  if (status["left_out"].get<bool>()) {
    text += (text.empty() ? "left out: " : "; left out: ") + status["cause"].get<std::string>();
  }
  return text;
}

std::string percent(const Json& part, const Json& whole) {
  const auto all = whole.get<double>();
  return all > 0.0 ? fixed(100.0 * part.get<double>() / all, 1) : "-";
}

std::string learned(const Json& value, const Json& sigma) {
  return is_number(sigma) && sigma.get<double>() > 0.0
             ? with_sigma(value.get<double>(), sigma.get<double>(), 2, "")
             : "-";
}

/// It is 0 before the first comparison.
std::string nis(const Json& value) {
  return is_number(value) && value.get<double>() > 0.0 ? fixed(value, 2) : "-";
}

/// A replay does not measure it.
std::string milliseconds(const Json& latency_us) {
  const auto us = latency_us.get<double>();
  return us > 0.0 ? fixed(us / 1000.0, 1) : "-";
}

/// As wide as most terminals, 80 columns.
constexpr std::string_view kColumns =
    "radar           scans/s lost % targets    NIS mount yaw deg p99 ms  last motion";

void add_radar(const Json& radar, std::vector<ScreenLine>& lines) {
  const Json& status = radar["status"];
  const bool has_status = !status.is_null();
  const std::string silent = silence(radar["silent_s"]);
  const std::string doubted = has_status ? doubts(status) : "";
  const Mood mood = !silent.empty() ? Mood::bad : doubted.empty() ? Mood::plain : Mood::careful;
  lines.push_back(
      {fmt::format(
           "{:<16}{:>7}{:>7}{:>8}{:>7}{:>14}{:>7}  {}", ascii(radar["name"].get<std::string>()),
           fixed(radar["scan_rate_hz"], 1),
           has_status ? percent(status["scans_incomplete"], status["scans"]) : "-",
           radar["targets"].get<int>(), nis(has_status ? status["odometry_nis_doppler"] : Json()),
           has_status ? learned(status["mount_yaw_deg"], status["mount_yaw_sigma_deg"]) : "-",
           has_status ? milliseconds(status["latency_p99_us"]) : "-",
           silent.empty() ? words(radar["motion"]) : silent),
       mood});
  if (!doubted.empty()) {
    lines.push_back({"  " + doubted, mood});
  }
}

}  // namespace

std::vector<ScreenLine> screen_of(const Json& state, const std::string& source) {
  std::vector<ScreenLine> lines{heading(state, source), {}, status_line(state["pose"])};
  add_motion(state["rates"], lines);
  add_pose(state["pose"], lines);
  lines.push_back({});
  lines.push_back({std::string(kColumns)});
  for (const Json& radar : state["radars"]) {
    add_radar(radar, lines);
  }
  return lines;
}

}  // namespace cremed
