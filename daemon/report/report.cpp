// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <string_view>

#include <spdlog/fmt/fmt.h>

#include "cremed/can_decoders/radar_family.hpp"
#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/output/counter_rows.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

using Findings = std::vector<Finding>;

std::uint64_t count_of(const RadarStatus& status, MotionStatus motion) {
  return status.motions_by_status[static_cast<std::size_t>(motion)];
}

/// "name n" for each fault that was counted.
template <typename Rows, typename Counters>
std::string faults_text(const Rows& rows, const Counters& counters) {
  std::string text;
  for (const auto& row : rows) {
    if (const std::uint64_t count = counters.*row.counter; count != 0 && !row.name.empty()) {
      text += concat({text.empty() ? "" : ", ", row.name, " ", std::to_string(count)});
    }
  }
  return text;
}

const Ars408Options* ars408_options(const RadarConfiguration& radar) {
  return radar.decoder.as<Ars408Options>();
}

void add_silence(const RadarConfiguration& radar, const RadarStatus& status, Findings& findings) {
  if (status.decoder.frames == 0) {
    findings.push_back(
        {Severity::error, concat({"no frame with this radar's identifiers on ", radar.interface}),
         status.source.frames == 0
             ? "no frame of any radar either: check the interface, its bit rate and the cable"
             : "check its sensor_id or base_id; `cremed-doctor` names what is on the bus"});
  }
}

void add_wrong_mode(const RadarConfiguration& radar, const RadarStatus& status,
                    const Ars408Options& options, Findings& findings) {
  if (status.decoder.wrong_mode == 0 || status.assembler.scans != 0) {
    return;
  }
  if (options.output == Ars408Output::clusters) {
    findings.push_back({Severity::error, "the sensor sends objects, not clusters",
                        configure_command(radar) + ", or set output = \"objects\""});
  } else {
    findings.push_back(
        {Severity::error, "the sensor sends clusters, not objects", "set output = \"clusters\""});
  }
}

/// A scan is complete only with the quality message of each target.
void add_unknown_quality(const RadarConfiguration& radar, const RadarStatus& status,
                         Findings& findings) {
  const AssemblerCounters& scans = status.assembler;
  if (!status.health.is_known && scans.scans > 2 && scans.incomplete_scans == scans.scans) {
    findings.push_back({Severity::error,
                        "no scan is complete, and no 0x201 gives the sensor's settings",
                        "if it sends no quality: " + configure_command(radar)});
  }
}

struct Cause {
  std::uint64_t count;
  std::string_view remedy;
};

std::string_view remedy_of_most(std::initializer_list<Cause> causes) {
  return std::ranges::max_element(causes, {}, &Cause::count)->remedy;
}

void add_no_detection(const RadarConfiguration& radar, const RadarStatus& status,
                      Findings& findings) {
  const AssemblerCounters& scans = status.assembler;
  const SelectionCounters& c = status.selection;
  if (scans.scans > 0 && scans.empty_scans == scans.scans) {
    findings.push_back(
        {Severity::error, "all scans are empty",
         ars408_options(radar) == nullptr
             ? "the sensor sees nothing: is it covered?"
             : concat({"the sensor sees nothing, or its own filters (0x202) let nothing pass: "
                       "`cremed-doctor --ars408-filters ",
                       radar.name, "`"})});
  } else if (estimates(status) == 0 && c.used == 0 && scans.scans > scans.incomplete_scans) {
    const std::string_view remedy = remedy_of_most(
        {{c.no_noise, "the sensor rates no target: is it covered, or in a test mode?"},
         {c.invalid_state, "add the codes the sensor sends to keep_invalid_states"},
         {c.moving,
          "give the sensor speed and yaw rate (0x300, 0x301), or set "
          "keep_dyn_props = [0, 1, 2, 3, 4, 5, 6, 7]"},
         {c.low_existence, "lower min_existence_code or min_existence"},
         {c.no_position, "all targets are at range 0: is this radar of the configured type?"},
         {c.outside_limits, "widen [radar.limits]"}});
    findings.push_back(
        {Severity::error,
         "complete scans, but no usable detection: " + faults_text(kSelectionRows, c),
         std::string(remedy)});
  }
}

std::string_view remedy_of_most_motions(const RadarStatus& status) {
  return remedy_of_most(
      {{count_of(status, MotionStatus::incomplete_scan),
        "find out why parts of scans contradict each other: two sensors with one id?"},
       {count_of(status, MotionStatus::gap_too_long), "find out why scans come so rarely"},
       {count_of(status, MotionStatus::too_few_targets),
        "let more detections pass (keep_dyn_props, [radar.limits]) or lower min_targets"},
       {count_of(status, MotionStatus::degenerate), "the surroundings hold too few fixed targets"},
       {count_of(status, MotionStatus::no_convergence),
        "narrow [radar.limits] to what it sees well, and leave out the vehicle's own parts"},
       {count_of(status, MotionStatus::non_finite), "report it: it is a bug in cremed"},
       {count_of(status, MotionStatus::implausible),
        "check type and the keys that invert a sign: no vehicle is faster than 70 m/s or 3 rad/s"},
       {count_of(status, MotionStatus::ambiguous),
        "its mount or a sign is wrong, the surroundings hold too few fixed targets, or its noise "
        "is set too small: `cremed-eval calibrate LOG --config FILE`"}});
}

/// Most scans without an estimate had several explanations, as they have if the mount is wrong.
bool is_mostly_ambiguous(const RadarStatus& status) {
  return 2 * count_of(status, MotionStatus::ambiguous) >
         status.assembler.scans - std::min(status.assembler.scans, estimates(status));
}

/// Usable detections, but few complete scans gave an estimate. A lateral radar that sees few
/// targets at a time gives none by itself, and is of use to the odometry.
void add_few_estimates(const RadarStatus& status, Findings& findings) {
  constexpr std::uint64_t kMinScans = 10;
  const std::uint64_t whole = status.assembler.scans - status.assembler.incomplete_scans;
  const std::uint64_t good = estimates(status);
  const bool is_of_use = good != 0 && 2 * status.scans_in_odometry >= whole;
  if (status.selection.used != 0 && whole >= kMinScans && 2 * good < whole && !is_of_use) {
    findings.push_back({good == 0 ? Severity::error : Severity::warning,
                        concat({"few scans give an estimate: ", summary(status)}),
                        std::string(remedy_of_most_motions(status))});
  }
}

void add_setting(const RadarConfiguration& radar, const RadarHealth& health, Findings& findings) {
  if (health.output == RadarHealth::Output::none) {
    findings.push_back({Severity::error, "the sensor is configured to send no targets (0x201)",
                        configure_command(radar)});
  } else if (!health.sends_quality) {
    findings.push_back({Severity::error,
                        "the sensor sends no quality (0x201), so no scan is complete",
                        configure_command(radar)});
  }
}

void add_missing_motion(const RadarHealth& health, const Ars408Options& options,
                        Findings& findings) {
  const bool no_speed = (health.faults & RadarHealth::speed_missing) != 0;
  const bool no_yaw_rate = (health.faults & RadarHealth::yaw_rate_missing) != 0;
  if ((no_speed || no_yaw_rate) && options.keep_dyn_props != kEveryDynProp) {
    findings.push_back(
        {Severity::warning,
         concat({"the sensor gets no ", no_speed ? "speed (0x300)" : "",
                 no_speed && no_yaw_rate ? " and no " : "", no_yaw_rate ? "yaw rate (0x301)" : "",
                 ": its DynProp is wrong while driving"}),
         "send them from the vehicle's bus, or set keep_dyn_props = [0, 1, 2, 3, 4, 5, 6, 7], and "
         "motion_feedback = true if no other node can send them"});
  }
}

struct FaultText {
  RadarHealth::Fault fault;
  std::string_view name;
  std::string_view remedy;
};

constexpr std::array<FaultText, 11> kFaults{{
    {RadarHealth::persistent_error, "persistent error",
     "restart the sensor; if it stays, replace it"},
    {RadarHealth::temporary_error, "temporary error", "wait, then restart the sensor"},
    {RadarHealth::temperature_error, "temperature error", "cool or warm the sensor"},
    {RadarHealth::voltage_error, "voltage error", "check the sensor's supply, 8 to 32 V"},
    {RadarHealth::interference, "interference",
     "another radar of its band disturbs it: move or switch off one"},
    {RadarHealth::blind, "blind", "clean the sensor, and what is in front of it"},
    {RadarHealth::software_failure, "software failure", "restart the sensor"},
    {RadarHealth::can_failure, "CAN failure", "check its cable and termination"},
    {RadarHealth::configuration_failure, "configuration failure", "configure the sensor anew"},
    {RadarHealth::not_safe, "not safe", "see its data sheet"},
    {RadarHealth::trouble_code, "trouble code", "see its data sheet"},
}};

void add_faults(const RadarHealth& health, Findings& findings) {
  for (const FaultText& text : kFaults) {
    if ((health.faults & text.fault) != 0) {
      findings.push_back({Severity::warning, concat({"the sensor reports a fault: ", text.name}),
                          std::string(text.remedy)});
    }
  }
}

/// "12.3".
std::string decimal(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2);
}

struct DoubtText {
  Doubt doubt;
  double BeliefStatus::*nis;
  std::string_view what;
  std::string_view remedy;
};

constexpr std::array<DoubtText, 3> kDoubts{{
    {registration_contradicts_doppler, &BeliefStatus::doppler_nis,
     "the positions of its targets contradict their Doppler",
     "check the mount's yaw, the sign of Doppler and azimuth, and whether its noise is set too "
     "small: `cremed-eval calibrate LOG --config FILE`"},
    {motions_contradict_each_other, &BeliefStatus::next_nis,
     "its motion jumps more than a vehicle's can",
     "check mount and detections; `cremed-eval calibrate LOG --config FILE` estimates its noise"},
    {covariance_too_large, &BeliefStatus::doppler_nis,
     "its errors are far smaller than its covariance",
     "lower its noise ([radar.calibration]): `cremed-eval calibrate LOG --config FILE`"},
}};

/// That positions contradict Doppler follows from what explains it.
void add_doubts(const BeliefStatus& belief, bool is_explained, Findings& findings) {
  const std::uint32_t doubts =
      belief.doubts & ~(is_explained ? registration_contradicts_doppler : 0U);
  for (const DoubtText& text : kDoubts) {
    if ((doubts & text.doubt) != 0) {
      findings.push_back(
          {Severity::warning,
           concat({"its covariance is not credible: ", text.what,
                   " (normalised innovation squared ", decimal(belief.*text.nis), ", 1 expected)"}),
           std::string(text.remedy)});
    }
  }
}

std::string remedy_of_sign(const RadarConfiguration& radar) {
  const std::string_view key = radar.decoder.family().doppler_sign_key;
  return concat({key.empty() ? "" : concat({"change ", key, ", or "}), "turn mount.yaw_rad by pi"});
}

std::string remedy_of_upside_down(const RadarConfiguration& radar) {
  const std::string_view key = radar.decoder.family().azimuth_sign_key;
  return concat({"if it is mounted upside down, ", key.empty() ? "turn it over" : "change ", key});
}

void add_wrong_speed(const RadarConfiguration& radar, const BeliefStatus& belief,
                     const FaultCause& cause, Findings& findings) {
  const bool may_be_scale = cause.kind == FaultKind::unknown || cause.kind == FaultKind::scale;
  if (belief.doppler_correction.value_or(1.0) < 0.0) {
    findings.push_back({Severity::warning,
                        "its Doppler has the wrong sign by the positions of its targets",
                        remedy_of_sign(radar)});
  } else if (belief.doppler_correction && may_be_scale) {
    const double percent = 100.0 * (1.0 / *belief.doppler_correction - 1.0);
    findings.push_back(
        {Severity::warning,
         concat({"its Doppler is ", decimal(std::abs(percent)), " % too ",
                 percent > 0.0 ? "large" : "small", " by the positions of its targets"}),
         "the sensor or the scale of its signal is wrong; if it is so on every drive, "
         "`cremed-eval calibrate LOG --config FILE` finds calibration.doppler_scale"});
  } else if ((belief.doubts & positions_contradict_speed) != 0) {
    findings.push_back(
        {Severity::warning, "the positions of its targets give another speed than their Doppler",
         "Doppler has the wrong sign, is stuck or over ground (it must be relative to the sensor), "
         "or the stamps run faster or slower than time: compare both with the speedometer"});
  }
}

void add_clock(const BeliefStatus& belief, Findings& findings) {
  if ((belief.doubts & stamps_run_ahead) != 0) {
    findings.push_back(
        {Severity::warning,
         "its stamps are ahead of those of all other buses: the odometry does not use it",
         "the clock that stamps this bus is wrong: that of its adapter, or of what recorded it"});
  }
  if ((belief.doubts & stamps_run_behind) != 0) {
    findings.push_back(
        {Severity::warning,
         "its stamps are behind those of all other buses: the odometry does not use it",
         "the clock that stamps this bus is wrong, or a gateway holds its frames back"});
  }
}

struct CauseText {
  std::string what;
  std::string remedy;
};

/// "; if it is so on every drive, KEY = VALUE", if the key can have this value.
std::string lasting(std::string_view key, double value, Range possible) {
  return possible.min <= value && value <= possible.max
             ? concat({"; if it is so on every drive, calibration.", key, " = ", digits(value)})
             : "";
}

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

CauseText cause_text(const RadarConfiguration& radar, const FaultCause& cause,
                     std::span<const RadarConfiguration> all) {
  const EgoMotionOptions& ego_motion = radar.ego_motion;
  const bool is_positive = cause.value > 0.0;
  switch (cause.kind) {
    case FaultKind::scale: {
      const double percent = 100.0 * (1.0 / cause.value - 1.0);
      return {concat({"its Doppler is ", decimal(std::abs(percent)), " % too ",
                      percent > 0.0 ? "large" : "small"}),
              concat({"the sensor or the scale of its signal is wrong",
                      lasting("doppler_scale",
                              rounded(cause.value * ego_motion.correction.doppler_scale, 1e3),
                              kDopplerScales)})};
    }
    case FaultKind::offset:
      return {concat({"all its Doppler is ", decimal(std::abs(cause.value)), " m/s off"}),
              "the sensor or the offset of its signal is wrong"};
    case FaultKind::sign:
      return {"its Doppler has the wrong sign, or it looks the other way", remedy_of_sign(radar)};
    case FaultKind::upside_down:
      return {"its left is its right", remedy_of_upside_down(radar)};
    case FaultKind::mount_yaw:
      return {
          concat({"it looks ", decimal(std::abs(cause.value) * kDegPerRad), " degrees further ",
                  is_positive ? "left" : "right", " than its mount says"}),
          concat({"if nothing is loose, mount.yaw_rad = ",
                  digits(rounded(std::remainder(ego_motion.vehicle_from_radar.yaw_rad + cause.value,
                                                2.0 * std::numbers::pi),
                                 1e3))})};
    case FaultKind::mount_x:
      return {concat({"it is ", decimal(std::abs(cause.value)), " m further ",
                      is_positive ? "ahead" : "back", " than its mount says"}),
              concat({"measure it: mount.x_m = ",
                      digits(rounded(ego_motion.vehicle_from_radar.x_m + cause.value, 1e1))})};
    case FaultKind::late:
      return {concat({"its scans are ", decimal(cause.value), " s late"}),
              concat({"find what delays its bus or its stamps",
                      lasting("stamp_offset_s", rounded(radar.stamp_offset_s - cause.value, 1e2),
                              kStampOffsetsS)})};
    case FaultKind::exchanged:
      return {concat({"it sees what a radar at the mount of ",
                      cause.other < all.size() ? all[cause.other].name : "another", " sees"}),
              "exchange their interfaces or sensor ids"};
    case FaultKind::unknown:
      break;
  }
  return {all.size() == 1 ? "its Doppler contradicts its positions"
                          : "it contradicts the other radars or its own positions",
          "its mount, the scale or sign of its Doppler, or its bus is wrong: compare them with the "
          "vehicle; `cremed-eval calibrate LOG --config FILE` finds its yaw, scale and offset"};
}

/// The names of the others at its mount.
std::string sharing_mount(const RadarConfiguration& radar,
                          std::span<const RadarConfiguration> all) {
  return joined_if(
      all,
      [&](const RadarConfiguration& other) {
        return other.name != radar.name &&
               other.ego_motion.vehicle_from_radar == radar.ego_motion.vehicle_from_radar;
      },
      &RadarConfiguration::name);
}

bool has_common_mount(const RadarConfiguration& radar, const RadarStatus& status,
                      std::span<const RadarConfiguration> all) {
  constexpr std::uint32_t kOfMount = registration_contradicts_doppler | other_radars_contradict;
  return (status.belief.doubts & kOfMount) != 0 && !sharing_mount(radar, all).empty();
}

/// The odometry uses the radar, and corrects for its error.
bool is_learned(const RadarStatus& status) {
  const FaultKind kind = status.odometry.cause.kind;
  return !status.odometry.is_left_out && (kind == FaultKind::mount_yaw || kind == FaultKind::scale);
}

bool has_fault(const RadarStatus& status) {
  return (status.belief.doubts & other_radars_contradict) != 0 || is_learned(status);
}

void add_fault(const RadarConfiguration& radar, const RadarStatus& status,
               std::span<const RadarConfiguration> all, Findings& findings) {
  if (has_fault(status)) {
    findings.push_back(fault_finding(radar, status, all));
  }
}

/// What contradicts its Doppler or its mount, once: the odometry names scale and sign of Doppler by
/// a value, and does not know all that its positions tell. Of a common mount common_mount() tells.
Findings contradictions_of(const RadarConfiguration& radar, const RadarStatus& status,
                           std::span<const RadarConfiguration> all) {
  const FaultKind kind = status.odometry.cause.kind;
  Findings findings;
  if (!has_fault(status) || (kind != FaultKind::scale && kind != FaultKind::sign)) {
    add_wrong_speed(radar, status.belief, status.odometry.cause, findings);
  }
  if (!has_common_mount(radar, status, all) && (findings.empty() || kind != FaultKind::unknown)) {
    add_fault(radar, status, all, findings);
  }
  return findings;
}

}  // namespace

std::string configure_command(const RadarConfiguration& radar) {
  return concat({"`cremed-doctor --configure-ars408 ", radar.name, "`"});
}

Finding fault_finding(const RadarConfiguration& radar, const RadarStatus& status,
                      std::span<const RadarConfiguration> all) {
  const CauseText text = cause_text(radar, status.odometry.cause, all);
  const std::string effect =
      is_learned(status)
          ? "; the odometry corrects for it"
          : concat({"; excluded from the odometry (normalised innovation squared of its "
                    "Doppler ",
                    decimal(status.odometry.doppler_nis), ", 1 expected)"});
  return {Severity::warning, text.what + effect, text.remedy};
}

std::optional<Finding> common_mount(const Configuration& configuration,
                                    const RadarConfiguration& radar, const RadarStatus& status) {
  if (!configuration.odometry.enabled || !has_common_mount(radar, status, configuration.radars)) {
    return std::nullopt;
  }
  const Pose2& mount = radar.ego_motion.vehicle_from_radar;
  return Finding{
      Severity::error,
      fmt::format("{} and {} have the same mount (x {:g} m, y {:g} m, yaw {:g} rad)", radar.name,
                  sharing_mount(radar, configuration.radars), mount.x_m, mount.y_m, mount.yaw_rad),
      "write where each radar is ([radar.mount]), from the middle of the rear axle; "
      "only radars one above the other share a mount"};
}

bool is_contradicted(const RadarConfiguration& radar, const RadarStatus& status,
                     std::span<const RadarConfiguration> all) {
  return has_common_mount(radar, status, all) || !contradictions_of(radar, status, all).empty();
}

void drop_doubts_of_turned_mount(RadarStatus& status) {
  status.belief.doubts &= ~registration_contradicts_doppler;
  const FaultKind kind = status.odometry.cause.kind;
  if (kind == FaultKind::mount_yaw || kind == FaultKind::unknown) {
    status.belief.doubts &= ~other_radars_contradict;
    status.odometry.cause = {};
  }
}

std::uint64_t estimates(const RadarStatus& status) {
  return count_of(status, MotionStatus::ok) + count_of(status, MotionStatus::standing_still);
}

std::string summary(const RadarStatus& status) {
  std::string text =
      fmt::format("{} scans, {} estimates", status.assembler.scans, estimates(status));
  for (std::size_t i = 1; i < kMotionStatusCount; ++i) {
    if (status.motions_by_status[i] != 0) {
      text += fmt::format(", {} {}", to_string(static_cast<MotionStatus>(i)),
                          status.motions_by_status[i]);
    }
  }
  return text;
}

std::string irregularities(const RadarStatus& status) {
  const std::string frames = faults_text(kDecoderRows, status.decoder);
  const std::string scans = faults_text(kScanRows, status.assembler);
  return concat({frames.empty() ? "" : "frames: ", frames,
                 frames.empty() || scans.empty() ? "" : "; ",
                 scans.empty() ? "" : "scans: ", scans});
}

std::vector<Finding> health_findings(const RadarConfiguration& radar, const RadarStatus& status) {
  Findings findings;
  if (!status.health.is_known) {
    return findings;
  }
  if (const Ars408Options* options = ars408_options(radar)) {
    add_setting(radar, status.health, findings);
    add_missing_motion(status.health, *options, findings);
  }
  add_faults(status.health, findings);
  return findings;
}

std::vector<Finding> radar_findings(const RadarConfiguration& radar, const RadarStatus& status,
                                    std::span<const RadarConfiguration> all) {
  Findings findings;
  add_silence(radar, status, findings);
  if (const Ars408Options* options = ars408_options(radar)) {
    add_wrong_mode(radar, status, *options, findings);
    add_unknown_quality(radar, status, findings);
  }
  add_no_detection(radar, status, findings);
  const Findings health = health_findings(radar, status);
  findings.insert(findings.end(), health.begin(), health.end());
  const Findings contradictions = contradictions_of(radar, status, all);
  findings.insert(findings.end(), contradictions.begin(), contradictions.end());
  const bool is_explained = is_contradicted(radar, status, all);
  if (!is_explained || !is_mostly_ambiguous(status)) {
    add_few_estimates(status, findings);
  }
  add_doubts(status.belief, is_explained, findings);
  add_clock(status.belief, findings);
  return findings;
}

}  // namespace cremed
