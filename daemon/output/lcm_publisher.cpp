// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/lcm_publisher.hpp"

#include <algorithm>
#include <bitset>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>

#include "daemon/output/counter_rows.hpp"
#include "daemon/output/multicast_route.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr const char* kMotionChannel = "CREMED_EGO_MOTION";
constexpr const char* kStatusChannel = "CREMED_STATUS";

/// Applies `change` to the array of each field of the targets.
template <typename Change>
void for_each_field(radar_scan_t& scan, const Change& change) {
  change(scan.id);
  change(scan.validity);
  for (auto* values : {&scan.range_m, &scan.azimuth_rad, &scan.doppler_mps, &scan.range_std_m,
                       &scan.azimuth_std_rad, &scan.doppler_std_mps, &scan.rcs_dbm2}) {
    change(*values);
  }
}

void fill_mount(const Pose2& vehicle_from_radar, radar_scan_t& scan) {
  scan.mount_x_in_vehicle_frame_m = vehicle_from_radar.x_m;
  scan.mount_y_in_vehicle_frame_m = vehicle_from_radar.y_m;
  scan.mount_yaw_in_vehicle_frame_rad = vehicle_from_radar.yaw_rad;
}

void append(const Detection& detection, radar_scan_t& scan) {
  scan.id.push_back(static_cast<std::int16_t>(detection.id));
  scan.validity.push_back(static_cast<std::int8_t>(detection.validity));
  scan.range_m.push_back(static_cast<float>(detection.range_m));
  scan.azimuth_rad.push_back(static_cast<float>(detection.azimuth_rad));
  scan.doppler_mps.push_back(static_cast<float>(detection.doppler_mps));
  scan.range_std_m.push_back(static_cast<float>(detection.range_std_m));
  scan.azimuth_std_rad.push_back(static_cast<float>(detection.azimuth_std_rad));
  scan.doppler_std_mps.push_back(static_cast<float>(detection.doppler_std_mps));
  scan.rcs_dbm2.push_back(static_cast<float>(detection.rcs_dbm2));
}

using S = status_t;

void set(std::int32_t place, std::uint64_t value, status_t& m) {
  m.counters[place] = static_cast<std::int64_t>(value);
}

void set(std::int32_t place, double value, status_t& m) {
  m.figures[place] = static_cast<float>(value);
}

void fill_source(const SourceCounters& source, status_t& m) {
  set(S::COUNTER_FRAMES_READ, source.frames, m);
  set(S::COUNTER_FRAMES_OF_OTHER_INTERFACES, source.other_interface_frames, m);
  set(S::COUNTER_FRAMES_LOST_UPSTREAM, source.lost_frames, m);
  set(S::COUNTER_MALFORMED_LINES, source.malformed_lines, m);
}

void fill_bus(const BusStatus& bus, status_t& m) {
  m.link_state = static_cast<std::int8_t>(bus.link);
  m.bus_state = static_cast<std::int8_t>(bus.bus);
  set(S::COUNTER_BUS_FRAMES, bus.frames, m);
  set(S::COUNTER_BUS_FRAMES_LOST, bus.frames_lost, m);
  set(S::COUNTER_BUS_FRAMES_STALE, bus.frames_stale, m);
  set(S::COUNTER_BUS_FRAMES_DISCARDED, bus.frames_discarded, m);
  set(S::COUNTER_BUS_ERROR_FRAMES, bus.error_frames, m);
  set(S::COUNTER_BUS_OFFS, bus.bus_offs, m);
  set(S::COUNTER_BUS_RESTARTS, bus.restarts, m);
  set(S::COUNTER_BUS_INTERRUPTIONS, bus.interruptions, m);
  set(S::COUNTER_BUS_FRAMES_SENT, bus.frames_sent, m);
  set(S::COUNTER_BUS_SEND_FAILURES, bus.send_failures, m);
  set(S::COUNTER_CLOCK_STEPS, bus.clock_steps, m);
}

void fill_health(const RadarHealth& health, status_t& m) {
  m.radar_has_reported = health.is_known ? 1 : 0;
  m.radar_output = static_cast<std::int8_t>(health.output);
  m.radar_sends_quality = health.sends_quality ? 1 : 0;
  m.radar_faults = static_cast<std::int32_t>(health.faults);
  set(S::FIGURE_RADAR_MAX_DISTANCE_M, health.max_distance_m, m);
}

void fill_belief(const BeliefStatus& belief, status_t& m) {
  m.doubts = static_cast<std::int32_t>(belief.doubts);
  m.speed_checked = belief.is_speed_checked ? 1 : 0;
  set(S::FIGURE_NIS_DOPPLER, belief.doppler_nis, m);
  set(S::FIGURE_NIS_NEXT, belief.next_nis, m);
}

void fill_odometry(const RadarReport& report, status_t& m) {
  m.odometry_leaves_out = report.is_left_out ? 1 : 0;
  m.odometry_fault = static_cast<std::int8_t>(report.cause.kind);
  m.odometry_fault_value = static_cast<float>(report.cause.value);
  m.odometry_fault_radar = static_cast<std::int8_t>(report.cause.other);
  set(S::FIGURE_ODOMETRY_NIS_DOPPLER, report.doppler_nis, m);
  set(S::FIGURE_ODOMETRY_NIS_LATERAL, report.lateral_nis, m);
  set(S::FIGURE_ODOMETRY_NIS_YAW, report.yaw_nis, m);
  set(S::FIGURE_ODOMETRY_DOPPLER_NOISE_FACTOR, report.doppler_noise_factor, m);
  set(S::FIGURE_ODOMETRY_POSITION_NOISE_FACTOR, report.position_noise_factor, m);
  set(S::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_RAD, report.mount_yaw_rad, m);
  set(S::FIGURE_ODOMETRY_MOUNT_YAW_ERROR_STD_RAD, report.mount_yaw_std_rad, m);
  set(S::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR, report.doppler_scale, m);
  set(S::FIGURE_ODOMETRY_DOPPLER_SCALE_ERROR_STD, report.doppler_scale_std, m);
  set(S::COUNTER_ODOMETRY_TARGETS_AT_REST, report.targets.at_rest, m);
  set(S::COUNTER_ODOMETRY_TARGETS_FOUND, report.targets.found, m);
  set(S::COUNTER_ODOMETRY_TARGETS_MOVING, report.targets.moving, m);
}

template <typename Rows, typename Counters>
void fill_counters(const Rows& rows, const Counters& counters, status_t& m) {
  for (const auto& row : rows) {
    set(row.place, counters.*row.counter, m);
  }
}

void fill(const RadarStatus& status, status_t& m) {
  m.utime = status.utime_us;
  m.last_motion_status = static_cast<std::int8_t>(status.last_motion_status);
  m.utime_last_estimate = status.utime_last_estimate_us;
  m.latency_p50_us = static_cast<std::int32_t>(status.latency.p50_us);
  m.latency_p99_us = static_cast<std::int32_t>(status.latency.p99_us);
  m.latency_max_us = static_cast<std::int32_t>(status.latency.max_us);
  fill_source(status.source, m);
  fill_bus(status.bus, m);
  fill_health(status.health, m);
  fill_counters(kDecoderRows, status.decoder, m);
  fill_counters(kScanRows, status.assembler, m);
  fill_counters(kSelectionRows, status.selection, m);
  fill_belief(status.belief, m);
  fill_odometry(status.odometry, m);
  set(S::COUNTER_SCANS_IN_ODOMETRY, status.scans_in_odometry, m);
  set(S::COUNTER_MOTIONS_OF_INCOMPLETE_SCANS, status.motions_of_incomplete_scans, m);
  std::copy(status.motions_by_status.begin(), status.motions_by_status.end(),
            std::begin(m.motions_by_status));
}

void copy(const Eigen::Matrix3d& matrix, double (&row_major)[9]) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> map(&row_major[0]);
  map = matrix;
}

void fill(const Odometry& odometry, odometry_t& m) {
  m.utime = odometry.utime_us;
  m.utime_anchor = odometry.utime_anchor_us;
  m.status = static_cast<std::int8_t>(odometry.status);
  m.radars_used = static_cast<std::int32_t>(odometry.radars);
  m.radars_left_out = static_cast<std::int32_t>(odometry.left_out);
  m.x_in_anchor_frame_m = odometry.pose.x();
  m.y_in_anchor_frame_m = odometry.pose.y();
  m.yaw_in_anchor_frame_rad = odometry.pose.z();
  copy(odometry.covariance, m.covariance_x_y_yaw_in_anchor_frame_m_rad);
  m.x_in_odom_frame_m = odometry.odom_pose.x();
  m.y_in_odom_frame_m = odometry.odom_pose.y();
  m.yaw_in_odom_frame_rad = odometry.odom_pose.z();
  copy(odometry.odom_covariance, m.covariance_x_y_yaw_in_odom_frame_m_rad);
  m.vx_in_vehicle_frame_mps = odometry.twist.x();
  m.vy_in_vehicle_frame_mps = odometry.twist.y();
  m.yaw_rate_radps = odometry.twist.z();
  copy(odometry.twist_covariance, m.covariance_vx_vy_yaw_rate_in_vehicle_frame_mps_radps);
}

/// The socket of LCM blocks when its send buffer is full, and LCM gives no access to it. It is
/// found among the descriptors that lcm_create opens and made non-blocking: a full buffer then
/// costs a message instead of delaying scans.
lcm_t* create_lcm(const std::string& url) {
  constexpr int kDescriptors = 256;
  const auto is_open = [](int descriptor) { return ::fcntl(descriptor, F_GETFD) >= 0; };
  std::bitset<kDescriptors> before;
  for (int i = 0; i < kDescriptors; ++i) {
    before[static_cast<std::size_t>(i)] = is_open(i);
  }
  errno = 0;
  lcm_t* lcm = lcm_create(url.c_str());
  const int error = errno;
  for (int i = 0; i < kDescriptors; ++i) {
    struct stat status {};
    if (!before[static_cast<std::size_t>(i)] && is_open(i) && ::fstat(i, &status) == 0 &&
        S_ISSOCK(status.st_mode)) {
      ::fcntl(i, F_SETFL, ::fcntl(i, F_GETFL) | O_NONBLOCK);
    }
  }
  errno = error;
  return lcm;
}

}  // namespace

std::string channel_of(const std::string& channel, const std::string& source) {
  std::string name = channel + "_" + source;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

LcmPublisher::LcmPublisher(std::string url, const Configuration& configuration)
    : url_(std::move(url)),
      publish_scans_(configuration.output.publish_scans),
      nav_msgs_channel_(configuration.output.nav_msgs_odometry),
      messages_(configuration.radars.size()) {
  fused_.source = kFusedSource;
  fused_channel_ = channel_of(kMotionChannel, fused_.source);
  fused_.seq = odometry_.seq = 0;
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    const std::string& name = configuration.radars[i].name;
    Messages& messages = messages_[i];
    messages.motion.source = messages.scan.source = messages.status.source = name;
    messages.motion.seq = messages.scan.seq = messages.status.seq = 0;
    messages.status.last_motion_status = ego_motion_t::STATUS_NO_REFERENCE;  // 0 would mean ok.
    messages.motion_channel = channel_of(kMotionChannel, name);
    messages.scan_channel = channel_of("CREMED_SCAN", name);
    messages.status_channel = channel_of(kStatusChannel, name);
    fill_mount(configuration.radars[i].ego_motion.vehicle_from_radar, messages.scan);
    for_each_field(messages.scan, [](auto& values) { values.reserve(kMaxDetections); });
  }
}

/// Returns the problem; empty if it can publish.
std::string LcmPublisher::open() {
  const std::string path = lcm_file(url_);
  if (!path.empty() && url_.ends_with("mode=w")) {
    errno = 0;
    file_.emplace(path);
    return file_->is_open() ? std::string()
                            : concat({"cannot write ", path, ": ",
                                      errno != 0 ? std::strerror(errno) : "it is a pipe"});
  }
  if (std::string problem = multicast_problem(url_); !problem.empty()) {
    return problem;
  }
  lcm_.reset(create_lcm(url_));
  return lcm_ != nullptr ? std::string() : lcm_create_problem(errno);
}

std::string LcmPublisher::connect() {
  if (const std::string problem = open(); !problem.empty()) {
    file_.reset();
    return concat({"LCM at ", url_, ": ", problem});
  }
  const std::uint64_t before = failures();
  for (Messages& messages : messages_) {
    publish({kStatusChannel, messages.status_channel.c_str()},
            messages.status);  // As last known: counters must not decrease.
    ++messages.status.seq;
  }
  flush();
  if (failures() != before) {
    const std::string reason = problem();
    lcm_.reset();
    file_.reset();
    return concat({"LCM at ", url_, ": cannot publish", reason.empty() ? "" : ": ", reason});
  }
  return {};
}

void LcmPublisher::flush() {
  if (file_) {
    file_->flush();
  }
}

bool LcmPublisher::send(const char* channel, int size) {
  const auto bytes = static_cast<std::size_t>(size);
  return file_ ? file_->write(channel, {buffer_.data(), bytes})
               : lcm_ != nullptr && lcm_publish(lcm_.get(), channel, buffer_.data(),
                                                static_cast<unsigned int>(size)) == 0;
}

template <typename Message>
void LcmPublisher::publish(std::initializer_list<const char*> channels, const Message& message) {
  const int size = message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
  const bool is_sent =
      size >= 0 && std::ranges::all_of(channels, [&](auto channel) { return send(channel, size); });
  failures_ += is_sent ? 0U : 1U;
}

void LcmPublisher::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) {
  publish_motion(motion, solve_us, messages_[radar].motion_channel, messages_[radar].motion);
}

void LcmPublisher::on_odometry(const Odometry& odometry) {
  fill(odometry, odometry_);
  odometry_.doubts = 0;
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    odometry_.doubts |= ((odometry.radars >> i) & 1U) != 0 ? messages_[i].motion.doubts : 0;
  }
  fused_.doubts = odometry_.doubts;
  publish({"CREMED_ODOMETRY"}, odometry_);
  ++odometry_.seq;
  if (!nav_msgs_channel_.empty() && nav_msgs_.update(odometry)) {
    publish({nav_msgs_channel_.c_str()}, nav_msgs_.message());
  }
}

void LcmPublisher::on_fused(const EgoMotion& motion, std::int32_t solve_us) {
  publish_motion(motion, solve_us, fused_channel_, fused_);
}

void LcmPublisher::publish_motion(const EgoMotion& motion, std::int32_t solve_us,
                                  const std::string& channel, ego_motion_t& message) {
  message.utime = motion.utime_us;
  message.utime_start = motion.utime_start_us;
  message.status = static_cast<std::int8_t>(motion.status);
  message.incomplete = static_cast<std::int8_t>(motion.incomplete);
  message.x_in_start_frame_m = motion.motion.x();
  message.y_in_start_frame_m = motion.motion.y();
  message.yaw_in_start_frame_rad = motion.motion.z();
  copy(motion.covariance, message.covariance_x_y_yaw_m_rad);
  message.num_targets = motion.targets;
  message.num_iterations = motion.iterations;
  message.solve_us = solve_us;
  publish({kMotionChannel, channel.c_str()}, message);
  ++message.seq;
}

void LcmPublisher::on_scan(std::size_t radar, const RadarScan& scan) {
  if (!publish_scans_) {
    return;
  }
  radar_scan_t& message = messages_[radar].scan;
  message.utime = scan.stamp_us;
  message.status = static_cast<std::int8_t>(scan.status);
  message.counter = scan.counter;
  message.num_announced = scan.announced;
  message.num_detections = scan.count;
  for_each_field(message, [](auto& values) { values.clear(); });
  for (std::size_t i = 0; i < scan.count; ++i) {
    append(scan.detections[i], message);
  }
  publish({messages_[radar].scan_channel.c_str()}, message);
  ++message.seq;
}

void LcmPublisher::on_status(std::size_t radar, const RadarStatus& status) {
  status_t& m = messages_[radar].status;
  fill(status, m);
  set(S::COUNTER_MESSAGES_NOT_PUBLISHED, failures(), m);
  messages_[radar].motion.doubts = m.doubts;
  publish({kStatusChannel, messages_[radar].status_channel.c_str()}, m);
  ++m.seq;
}

}  // namespace cremed
