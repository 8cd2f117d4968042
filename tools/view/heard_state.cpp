// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/heard_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kMotionsUs = 60'000'000;
constexpr std::int64_t kMotionSpacingUs = 100'000;
constexpr std::int64_t kOldScanUs = 1'000'000;
/// Rates of scans are means over this time: 26 scans of an ARS408 as fast as it gets.
constexpr std::int64_t kRateUs = 2'000'000;
constexpr std::size_t kMostRateScans = 200;

/// status_t.DOUBT_*, from the lowest bit.
constexpr std::array<std::string_view, 7> kDoubtNames{"registration contradicts Doppler",
                                                      "motions contradict each other",
                                                      "other radars contradict",
                                                      "covariance too large",
                                                      "positions contradict speed",
                                                      "stamps run ahead",
                                                      "stamps run behind"};
/// status_t.CAUSE_*
constexpr std::array<std::string_view, 9> kCauseNames{
    "cause unknown", "scale of Doppler",       "sign of Doppler",
    "upside down",   "yaw of the mount",       "place of the mount",
    "late",          "exchanged with another", "offset of Doppler"};

Json doubts_json(const status_t& m) {
  Json names = Json::array();
  for (std::size_t bit = 0; bit < kDoubtNames.size(); ++bit) {
    if (((static_cast<std::uint32_t>(m.doubts) >> bit) & 1U) != 0) {
      names.push_back(kDoubtNames[bit]);
    }
  }
  return names;
}

std::string_view cause_name(int cause) {
  const auto number = static_cast<std::size_t>(cause);
  return kCauseNames[number < kCauseNames.size() ? number : 0];
}

/// "unknown" for a number that is none of the type's.
template <typename Status>
std::string status_name(int number, std::size_t count) {
  return number >= 0 && static_cast<std::size_t>(number) < count
             ? std::string(to_string(static_cast<Status>(number)))
             : "unknown";
}

double std_of(double variance) { return std::sqrt(std::max(variance, 0.0)); }

double seconds(std::int64_t time_us) { return 1e-6 * static_cast<double>(time_us); }

Json pose_json(const odometry_t& m) {
  const auto& covariance = m.covariance_x_y_yaw_in_odom_frame_m_rad;
  return {{"utime", m.utime},
          {"status", status_name<OdometryStatus>(m.status, kOdometryStatusCount)},
          {"x", m.x_in_odom_frame_m},
          {"y", m.y_in_odom_frame_m},
          {"yaw", m.yaw_in_odom_frame_rad},
          {"covariance", {covariance[0], covariance[1], covariance[4], covariance[8]}}};
}

Json path_json(const std::vector<PathPoint>& points) {
  Json x = Json::array();
  Json y = Json::array();
  for (const PathPoint& point : points) {
    x.push_back(std::round(100.0 * point.x_m) / 100.0);
    y.push_back(std::round(100.0 * point.y_m) / 100.0);
  }
  return {{"x", std::move(x)}, {"y", std::move(y)}};
}

Json status_json(const status_t& m) {
  const auto figure = [&](std::int32_t place, double factor = 1.0) {
    return factor * static_cast<double>(m.figures[place]);
  };
  return {{"doubts", doubts_json(m)},
          {"nis_doppler", figure(status_t::FIGURE_NIS_DOPPLER)},
          {"nis_next", figure(status_t::FIGURE_NIS_NEXT)},
          {"odometry_nis_doppler", figure(status_t::FIGURE_ODOMETRY_NIS_DOPPLER)},
          {"odometry_nis_lateral", figure(status_t::FIGURE_ODOMETRY_NIS_LATERAL)},
          {"odometry_nis_yaw", figure(status_t::FIGURE_ODOMETRY_NIS_YAW)},
          {"mount_yaw_deg", figure(status_t::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_RAD, kDegPerRad)},
          {"mount_yaw_sigma_deg",
           figure(status_t::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_STD_RAD, kDegPerRad)},
          {"doppler_scale_percent", figure(status_t::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR, 100.0)},
          {"doppler_scale_sigma_percent",
           figure(status_t::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR_STD, 100.0)},
          {"latency_p50_us", m.latency_p50_us},
          {"latency_p99_us", m.latency_p99_us},
          {"latency_max_us", m.latency_max_us},
          {"scans", m.counters[status_t::COUNTER_SCANS]},
          {"scans_incomplete", m.counters[status_t::COUNTER_SCANS_INCOMPLETE]},
          {"left_out", m.odometry_leaves_out != 0},
          {"cause", cause_name(m.odometry_fault)}};
}

long hundredths(float value) { return std::isfinite(value) ? std::lround(100.0F * value) : 0; }

Json silent_s(const std::optional<std::chrono::steady_clock::time_point>& heard,
              std::chrono::steady_clock::time_point now) {
  return heard ? Json(std::chrono::duration<double>(now - *heard).count()) : Json();
}

double behind_s(std::int64_t utime_us) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count() - seconds(utime_us);
}

/// Null before the second scan.
Json rate_hz(const std::deque<std::int64_t>& scans_us) {
  if (scans_us.size() < 2) {
    return {};
  }
  return static_cast<double>(scans_us.size() - 1) / seconds(scans_us.back() - scans_us.front());
}

/// A stamp that is not later than the last begins anew.
void note_scan(std::int64_t stamp_us, std::deque<std::int64_t>& scans_us) {
  if (!scans_us.empty() && stamp_us <= scans_us.back()) {
    scans_us.clear();
  }
  scans_us.push_back(stamp_us);
  while (scans_us.front() < stamp_us - kRateUs || scans_us.size() > kMostRateScans) {
    scans_us.pop_front();
  }
}

/// As charts.js reads it.
Json targets_json(const radar_scan_t& m) {
  Json targets = Json::array();
  for (std::size_t i = 0; i < m.range_m.size(); ++i) {
    targets.push_back(hundredths(m.range_m[i]));
    targets.push_back(hundredths(100.0F * m.azimuth_rad[i]));
    targets.push_back(hundredths(m.doppler_mps[i]));
    targets.push_back(hundredths(m.doppler_std_mps[i]));
    targets.push_back(m.validity[i]);
  }
  return targets;
}

Json twist_json(const std::optional<odometry_t>& m) {
  return m ? Json{m->vx_in_vehicle_frame_mps, m->vy_in_vehicle_frame_mps, m->yaw_rate_radps}
           : Json();
}

Json scan_json(const radar_scan_t& m, const std::optional<odometry_t>& odometry) {
  return {{"source", m.source},
          {"utime", m.utime},
          {"mount",
           {m.mount_x_in_vehicle_frame_m, m.mount_y_in_vehicle_frame_m,
            m.mount_yaw_in_vehicle_frame_rad}},
          {"twist", twist_json(odometry)},
          {"targets", targets_json(m)}};
}

}  // namespace

void HeardState::note_message() {
  ++messages_;
  heard_ = std::chrono::steady_clock::now();
}

void HeardState::take(const odometry_t& message) {
  const std::scoped_lock lock(mutex_);
  note_message();
  if (odometry_ && (message.seq < odometry_->seq || message.utime < odometry_->utime)) {
    begin_anew();
  }
  odometry_ = message;
  odometry_heard_ = heard_;
  behind_s_ = behind_s(message.utime);
  path_.add({message.x_in_odom_frame_m, message.y_in_odom_frame_m});
  keep_motion(message);
}

void HeardState::end() {
  const std::scoped_lock lock(mutex_);
  ended_ = std::chrono::steady_clock::now();
}

void HeardState::begin_anew() {
  odometry_.reset();
  path_.clear();
  motions_.clear();
  radars_.clear();
}

void HeardState::keep_motion(const odometry_t& message) {
  if (!motions_.empty() && message.utime < motions_.back().utime + kMotionSpacingUs) {
    return;
  }
  motions_.push_back(message);
  while (motions_.front().utime < message.utime - kMotionsUs) {
    motions_.pop_front();
  }
}

/// Null where there are more than a configuration may have.
HeardState::Radar* HeardState::radar(const std::string& name) {
  const auto found = std::ranges::find(radars_, name, &Radar::name);
  if (found != radars_.end()) {
    return &*found;
  }
  if (radars_.size() == kMaxRadars || name == kFusedSource) {
    return nullptr;
  }
  radars_.emplace_back().name = name;
  return &radars_.back();
}

void HeardState::take(const ego_motion_t& message) {
  const std::scoped_lock lock(mutex_);
  note_message();
  if (Radar* const known = radar(message.source)) {
    known->motion = message;
    known->motion_heard = heard_;
    note_scan(message.utime, known->scans_us);
  }
}

void HeardState::take(const status_t& message) {
  const std::scoped_lock lock(mutex_);
  note_message();
  if (Radar* const known = radar(message.source)) {
    known->status = message;
  }
}

void HeardState::take(const radar_scan_t& message) {
  const std::scoped_lock lock(mutex_);
  note_message();
  if (Radar* const known = radar(message.source)) {
    known->scan = message;
    known->odometry_at_scan = odometry_;
  }
}

nlohmann::json HeardState::motions_json() const {
  Json rates{{"t", Json::array()},
             {"vx", Json::array()},
             {"vx_sigma", Json::array()},
             {"yaw_rate", Json::array()},
             {"yaw_rate_sigma", Json::array()}};
  for (const odometry_t& motion : motions_) {
    const auto& covariance = motion.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps;
    rates["t"].push_back(seconds(motion.utime - odometry_->utime));
    rates["vx"].push_back(motion.vx_in_vehicle_frame_mps);
    rates["vx_sigma"].push_back(std_of(covariance[0]));
    rates["yaw_rate"].push_back(kDegPerRad * motion.yaw_rate_radps);
    rates["yaw_rate_sigma"].push_back(kDegPerRad * std_of(covariance[8]));
  }
  return rates;
}

nlohmann::json HeardState::scans_json() const {
  Json scans = Json::array();
  for (const Radar& radar : radars_) {
    if (radar.scan && (!odometry_ || radar.scan->utime > odometry_->utime - kOldScanUs)) {
      scans.push_back(scan_json(*radar.scan, radar.odometry_at_scan));
    }
  }
  return scans;
}

nlohmann::json HeardState::radar_json(const Radar& radar, Time now) {
  Json json{{"name", radar.name},
            {"motion", Json()},
            {"targets", 0},
            {"scan_rate_hz", rate_hz(radar.scans_us)},
            {"silent_s", silent_s(radar.motion_heard, now)},
            {"status", radar.status ? status_json(*radar.status) : Json()}};
  if (radar.motion) {
    json["motion"] = status_name<MotionStatus>(radar.motion->status, kMotionStatusCount);
    json["targets"] = radar.motion->num_targets;
  }
  return json;
}

nlohmann::json HeardState::snapshot() const {
  const std::scoped_lock lock(mutex_);
  const Time now = ended_.value_or(std::chrono::steady_clock::now());
  Json radars = Json::array();
  for (const Radar& radar : radars_) {
    radars.push_back(radar_json(radar, now));
  }
  Json pose;
  if (odometry_) {
    pose = pose_json(*odometry_);
    pose["silent_s"] = silent_s(odometry_heard_, now);
    pose["behind_s"] = behind_s_;
  }
  return {{"messages", messages_},
          {"silent_s", silent_s(heard_, now)},
          {"has_ended", ended_.has_value()},
          {"pose", std::move(pose)},
          {"path", path_json(path_.points())},
          {"rates", motions_json()},
          {"radars", std::move(radars)},
          {"scans", scans_json()}};
}

std::string HeardState::json() const {
  return snapshot().dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace cremed
