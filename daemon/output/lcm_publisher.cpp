// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/lcm_publisher.hpp"

#include <algorithm>
#include <bitset>
#include <cctype>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>

#include "daemon/output/multicast_route.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr const char* kMotionChannel = "CREMED_EGO_MOTION";
constexpr const char* kStatusChannel = "CREMED_STATUS";

void reserve(radar_scan_t& scan) {
  scan.id.reserve(kMaxDetections);
  scan.validity.reserve(kMaxDetections);
  for (auto* values : {&scan.range_m, &scan.azimuth_rad, &scan.doppler_mps, &scan.range_std_m,
                       &scan.azimuth_std_rad, &scan.doppler_std_mps, &scan.rcs_dbm2}) {
    values->reserve(kMaxDetections);
  }
}

void fill_mount(const Pose2& vehicle_from_radar, radar_scan_t& scan) {
  scan.mount_x_in_vehicle_frame_m = vehicle_from_radar.x_m;
  scan.mount_y_in_vehicle_frame_m = vehicle_from_radar.y_m;
  scan.mount_yaw_in_vehicle_frame_rad = vehicle_from_radar.yaw_rad;
}

void clear(radar_scan_t& scan) {
  scan.id.clear();
  scan.validity.clear();
  for (auto* values : {&scan.range_m, &scan.azimuth_rad, &scan.doppler_mps, &scan.range_std_m,
                       &scan.azimuth_std_rad, &scan.doppler_std_mps, &scan.rcs_dbm2}) {
    values->clear();
  }
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

std::int64_t count(std::uint64_t value) { return static_cast<std::int64_t>(value); }

void fill_bus(const BusStatus& bus, status_t& m) {
  m.link_state = static_cast<std::int8_t>(bus.link);
  m.bus_state = static_cast<std::int8_t>(bus.bus);
  m.bus_frames = count(bus.frames);
  m.bus_frames_lost = count(bus.frames_lost);
  m.bus_frames_stale = count(bus.frames_stale);
  m.bus_frames_discarded = count(bus.frames_discarded);
  m.bus_error_frames = count(bus.error_frames);
  m.bus_offs = count(bus.bus_offs);
  m.bus_restarts = count(bus.restarts);
  m.bus_interruptions = count(bus.interruptions);
  m.bus_frames_sent = count(bus.frames_sent);
  m.bus_send_failures = count(bus.send_failures);
  m.clock_steps = count(bus.clock_steps);
}

void fill_health(const RadarHealth& health, status_t& m) {
  m.radar_has_reported = health.is_known ? 1 : 0;
  m.radar_output = static_cast<std::int8_t>(health.output);
  m.radar_sends_quality = health.sends_quality ? 1 : 0;
  m.radar_max_distance_m = static_cast<float>(health.max_distance_m);
  m.radar_faults = static_cast<std::int32_t>(health.faults);
}

void fill_belief(const BeliefStatus& belief, status_t& m) {
  m.innovation_doppler = static_cast<float>(belief.doppler_innovation);
  m.innovation_next = static_cast<float>(belief.next_innovation);
  m.doubts = static_cast<std::int32_t>(belief.doubts);
  m.speed_checked = belief.is_speed_checked ? 1 : 0;
}

void fill_odometry(const RadarReport& report, status_t& m) {
  m.odometry_innovation_doppler = static_cast<float>(report.doppler_innovation);
  m.odometry_innovation_lateral = static_cast<float>(report.lateral_innovation);
  m.odometry_innovation_yaw = static_cast<float>(report.yaw_innovation);
  m.odometry_doppler_noise_factor = static_cast<float>(report.doppler_noise_factor);
  m.odometry_position_noise_factor = static_cast<float>(report.position_noise_factor);
  m.odometry_mount_yaw_error_rad = static_cast<float>(report.mount_yaw_rad);
  m.odometry_mount_yaw_error_std_rad = static_cast<float>(report.mount_yaw_std_rad);
  m.odometry_doppler_scale_error = static_cast<float>(report.doppler_scale);
  m.odometry_doppler_scale_error_std = static_cast<float>(report.doppler_scale_std);
  m.odometry_leaves_out = report.is_left_out ? 1 : 0;
  m.odometry_fault = static_cast<std::int8_t>(report.cause.kind);
  m.odometry_fault_value = static_cast<float>(report.cause.value);
  m.odometry_fault_radar = static_cast<std::int8_t>(report.cause.other);
  m.odometry_targets_at_rest = count(report.targets.at_rest);
  m.odometry_targets_found = count(report.targets.found);
  m.odometry_targets_moving = count(report.targets.moving);
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
    messages.motion_channel = channel_of(kMotionChannel, name);
    messages.scan_channel = channel_of("CREMED_SCAN", name);
    messages.status_channel = channel_of(kStatusChannel, name);
    fill_mount(configuration.radars[i].ego_motion.vehicle_from_radar, messages.scan);
    reserve(messages.scan);
  }
}

/// Returns the problem; empty if it can publish.
std::string LcmPublisher::open() {
  const std::string path = lcm_file(url_);
  if (!path.empty() && url_.ends_with("mode=w")) {
    file_.emplace(path);
    return file_->is_open() ? std::string() : concat({"cannot write ", path, "; must be a file"});
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
  const std::uint64_t failures = failures_;
  for (Messages& messages : messages_) {
    publish({kStatusChannel, messages.status_channel.c_str()},
            messages.status);  // As last known: counters must not decrease.
    ++messages.status.seq;
  }
  if (failures_ != failures) {
    const std::string reason = problem();
    lcm_.reset();
    file_.reset();
    return concat({"LCM at ", url_, ": cannot publish", reason.empty() ? "" : ": ", reason});
  }
  return {};
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
  const bool is_sent = size >= 0 && std::all_of(channels.begin(), channels.end(),
                                                [&](auto channel) { return send(channel, size); });
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
  clear(message);
  for (std::size_t i = 0; i < scan.count; ++i) {
    append(scan.detections[i], message);
  }
  publish({messages_[radar].scan_channel.c_str()}, message);
  ++message.seq;
}

void LcmPublisher::on_status(std::size_t radar, const RadarStatus& status) {
  status_t& m = messages_[radar].status;
  m.utime = status.utime_us;
  m.last_motion_status = static_cast<std::int8_t>(status.last_motion_status);
  m.utime_last_estimate = status.utime_last_estimate_us;

  m.frames_read = count(status.source.frames);
  m.frames_of_other_interfaces = count(status.source.other_interface_frames);
  m.frames_lost_before_us = count(status.source.lost_frames);
  m.malformed_lines = count(status.source.malformed_lines);

  fill_bus(status.bus, m);
  m.latency_p50_us = static_cast<std::int32_t>(status.latency.p50_us);
  m.latency_p99_us = static_cast<std::int32_t>(status.latency.p99_us);
  m.latency_max_us = static_cast<std::int32_t>(status.latency.max_us);
  fill_belief(status.belief, m);
  messages_[radar].motion.doubts = m.doubts;
  fill_odometry(status.odometry, m);
  m.scans_in_odometry = count(status.scans_in_odometry);
  fill_health(status.health, m);
  m.messages_not_published = count(failures_);

  m.frames_of_this_radar = count(status.decoder.frames);
  m.frames_state = count(status.decoder.state_frames);
  m.frames_wrong_length = count(status.decoder.wrong_length);
  m.frames_wrong_kind = count(status.decoder.wrong_kind);
  m.frames_wrong_mode = count(status.decoder.wrong_mode);
  m.frames_wrong_slot = count(status.decoder.wrong_slot);
  m.crc_errors = count(status.decoder.crc_errors);
  m.counter_errors = count(status.decoder.counter_errors);

  m.scans = count(status.assembler.scans);
  m.scans_incomplete = count(status.assembler.incomplete_scans);
  m.scans_without_header = count(status.assembler.headerless_scans);
  m.scans_empty = count(status.assembler.empty_scans);
  m.scans_timed_out = count(status.assembler.timeouts);
  m.scans_repeated = count(status.assembler.repeated_scans);
  m.scans_missed = count(status.assembler.missed_scans);
  m.parts_missing = count(status.assembler.missing_parts);
  m.parts_duplicate = count(status.assembler.duplicate_parts);
  m.parts_conflicting = count(status.assembler.conflicting_parts);
  m.parts_reordered = count(status.assembler.reordered_parts);
  m.parts_excess = count(status.assembler.excess_parts);
  m.parts_orphan = count(status.assembler.orphan_parts);
  m.stamps_backwards = count(status.assembler.stamps_backwards);

  m.detections_used = count(status.selection.used);
  m.detections_no_noise = count(status.selection.no_noise);
  m.detections_invalid_state = count(status.selection.invalid_state);
  m.detections_moving = count(status.selection.moving);
  m.detections_low_existence = count(status.selection.low_existence);
  m.detections_no_position = count(status.selection.no_position);
  m.detections_outside_limits = count(status.selection.outside_limits);

  m.motions_of_incomplete_scans = count(status.motions_of_incomplete_scans);
  for (std::size_t i = 0; i < kMotionStatusCount; ++i) {
    m.motions_by_status[i] = count(status.motions_by_status[i]);
  }
  publish({kStatusChannel, messages_[radar].status_channel.c_str()}, m);
  ++m.seq;
}

}  // namespace cremed
