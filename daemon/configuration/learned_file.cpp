// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/learned_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/configuration/toml_document.hpp"
#include "daemon/configuration/toml_reader.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/usage_error.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kVersion = 1;
/// Larger errors, in standard deviations of the prior, mean a wrong mount.
constexpr double kMaxStds = 5.0;
/// Smallest standard deviation of a learned error, as a share of the prior's.
constexpr double kLeastShare = 1e-3;
constexpr Range kMountRangeM{-100.0, 100.0};
constexpr Range kMountYawRangeRad{-10.0, 10.0};
/// Numbers are written with all digits, so any difference is a change.
constexpr double kTolerance = 1e-9;

constexpr const char* kHeader =
    "# Written by cremed: errors of the radars learned while driving, the prior of the next "
    "drive.\n# Delete it after work on the radars' mounts.\n";
constexpr const char* kRadarText =
    "\n[[radar]]\nname = {}\nmount_x_m = {:.17e}\nmount_y_m = {:.17e}\nmount_yaw_rad = {:.17e}\n"
    "mount_yaw_error_rad = {:.17e}\nmount_yaw_error_std_rad = {:.17e}\n"
    "doppler_scale_error = {:.17e}\ndoppler_scale_error_std = {:.17e}\n";
/// "# Written by cremed", by which a damaged file is known.
constexpr std::size_t kFirstWords = 19;

/// Whether the text can be what is left of a file with that header: its begin, or blocks of zeros.
bool may_be_own(std::string_view text) {
  const std::string_view known = std::string_view(kHeader).substr(0, kFirstWords);
  const std::string_view begin = text.substr(0, kFirstWords);
  return known.starts_with(begin) || begin.find_first_not_of('\0') == std::string_view::npos;
}

bool is_same(const Pose2& a, const Pose2& b) {
  return std::abs(a.x_m - b.x_m) <= kTolerance && std::abs(a.y_m - b.y_m) <= kTolerance &&
         std::abs(a.yaw_rad - b.yaw_rad) <= kTolerance;
}

bool is_plausible(const LearnedError& error, const LearnedError& unlearned) {
  return std::abs(error.value) <= kMaxStds * unlearned.std && std::isfinite(error.std);
}

LearnedError clipped(const LearnedError& error, const LearnedError& unlearned) {
  return {error.value, std::clamp(error.std, kLeastShare * unlearned.std, unlearned.std)};
}

}  // namespace

LearnedFile::LearnedFile(std::string path, const Configuration& configuration)
    : path_(std::move(path)) {
  for (const RadarConfiguration& radar : configuration.radars) {
    const Pose2& mount = radar.ego_motion.vehicle_from_radar;
    radars_.push_back({radar.name, mount, unlearned_errors(configuration.odometry.filter, mount)});
  }
}

LearnedFile::Content LearnedFile::parse(std::string_view toml) const {
  Diagnostics diagnostics(path_);
  Content content;
  content.radars.resize(radars_.size());
  if (const auto table = parse_toml(toml, diagnostics)) {
    TomlReader reader(table.get(), "", 1, diagnostics);
    std::int64_t version = 0;
    reader.integer("version", version, kVersion, kVersion);
    if (version == 0 && diagnostics.empty()) {
      reader.report("version", "is missing; must be 1");
    }
    for (TomlReader& radar : reader.tables("radar")) {
      read_radar(radar, content);
    }
    reader.finish();
  }
  if (!diagnostics.empty()) {
    content.radars.assign(radars_.size(), std::nullopt);
    content.problem = diagnostics.text();
    content.is_foreign = !may_be_own(toml);
  }
  return content;
}

/// A radar that is not configured is ignored, but its table must be well-formed.
void LearnedFile::read_radar(TomlReader& reader, Content& content) const {
  Radar entry;
  reader.text("name", entry.name, {[](std::string_view) { return true; }, "a radar's name"},
              Presence::required);
  reader.number("mount_x_m", entry.mount.x_m, kMountRangeM, Presence::required);
  reader.number("mount_y_m", entry.mount.y_m, kMountRangeM, Presence::required);
  reader.number("mount_yaw_rad", entry.mount.yaw_rad, kMountYawRangeRad, Presence::required);
  const auto found = std::ranges::find(radars_, entry.name, &Radar::name);
  const bool is_here = found != radars_.end() && is_same(found->mount, entry.mount);
  const LearnedErrors any{{0.0, kMountYawRangeRad.max}, {0.0, kMountYawRangeRad.max}};
  const LearnedErrors& most = is_here ? found->errors : any;
  const double least_share = is_here ? kLeastShare : 0.0;
  const auto read = [&](std::string_view key, std::string_view std_key,
                        LearnedError LearnedErrors::*which) {
    LearnedError& error = entry.errors.*which;
    const double most_std = (most.*which).std;
    const double most_value = kMaxStds * most_std;
    reader.number(key, error.value, {-most_value, most_value}, Presence::required);
    reader.number(std_key, error.std, {least_share * most_std, most_std}, Presence::required);
  };
  read("mount_yaw_error_rad", "mount_yaw_error_std_rad", &LearnedErrors::mount_yaw_rad);
  read("doppler_scale_error", "doppler_scale_error_std", &LearnedErrors::doppler_scale);
  reader.finish();
  if (found != radars_.end() && !is_here && reader.clean()) {
    content.passed_over.push_back(entry.name);
  } else if (is_here) {
    auto& errors = content.radars[static_cast<std::size_t>(found - radars_.begin())];
    if (errors) {
      reader.report("name", concat({"is ", in_quotes(entry.name), " twice; must be there once"}));
    }
    errors = entry.errors;
  }
}

LearnedFile::Content LearnedFile::read() const {
  try {
    return parse(read_toml(path_));
  } catch (const std::system_error& error) {
    Content content;
    content.radars.resize(radars_.size());
    if (error.code() != std::errc::no_such_file_or_directory) {
      content.problem = concat(
          {path_, ": cannot be read: ", std::generic_category().message(error.code().value()),
           "; must be a readable file"});
    }
    return content;
  }
}

void LearnedFile::refuse_foreign() const {
  if (read().is_foreign) {
    throw UsageError(concat({"state file: ", path_,
                             " is no file of learned errors and would be overwritten; name "
                             "another, or delete it"}));
  }
}

std::vector<std::optional<LearnedErrors>> LearnedFile::read_and_log() const {
  const Content content = read();
  if (!content.problem.empty()) {
    spdlog::warn(
        "{}\nthe learned errors are not used and will be overwritten; "
        "delete the file if this happens again",
        content.problem);
  }
  for (const std::string& name : content.passed_over) {
    spdlog::info("{}: its mount has changed, so its learned errors are not used", name);
  }
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (const auto& errors = content.radars[i]) {
      spdlog::info("{}: mount yaw {:+.2f} +- {:.2f} deg, Doppler {:+.2f} +- {:.2f} % by {}",
                   radars_[i].name, kDegPerRad * errors->mount_yaw_rad.value,
                   kDegPerRad * errors->mount_yaw_rad.std, 100.0 * errors->doppler_scale.value,
                   100.0 * errors->doppler_scale.std, path_);
    }
  }
  return content.radars;
}

std::optional<std::string> LearnedFile::text(
    std::span<const std::optional<LearnedErrors>> learned) const {
  std::string text = concat({kHeader, "version = 1\n"});
  bool is_empty = true;
  for (std::size_t i = 0; i < std::min(radars_.size(), learned.size()); ++i) {
    const Radar& radar = radars_[i];
    if (!learned[i] || !is_plausible(learned[i]->mount_yaw_rad, radar.errors.mount_yaw_rad) ||
        !is_plausible(learned[i]->doppler_scale, radar.errors.doppler_scale)) {
      continue;
    }
    const LearnedError yaw = clipped(learned[i]->mount_yaw_rad, radar.errors.mount_yaw_rad);
    const LearnedError scale = clipped(learned[i]->doppler_scale, radar.errors.doppler_scale);
    text += fmt::format(kRadarText, in_quotes(radar.name), radar.mount.x_m, radar.mount.y_m,
                        radar.mount.yaw_rad, yaw.value, yaw.std, scale.value, scale.std);
    is_empty = false;
  }
  return is_empty ? std::nullopt : std::optional(text);
}

}  // namespace cremed
