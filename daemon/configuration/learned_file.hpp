// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/estimator/fusion/state/learned_errors.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

class TomlReader;

/// The learned errors of the radars, stored between drives as TOML:
///
///     version = 1
///     [[radar]]
///     name = "front"
///     mount_x_m = 3.412                    # As configured when it was learned.
///     mount_y_m = 0.0
///     mount_yaw_rad = 0.003
///     mount_yaw_error_rad = -0.0012        # True yaw less that, less the mean of all radars.
///     mount_yaw_error_std_rad = 0.0021
///     doppler_scale_error = 0.0004         # Its Doppler is too great by this part, less the mean.
///     doppler_scale_error_std = 0.0017
///
/// A file with any error is ignored as a whole. A radar whose mount has changed is skipped.
class LearnedFile {
 public:
  LearnedFile(std::string path, const Configuration& configuration);

  struct Content {
    std::vector<std::optional<LearnedErrors>> radars;  ///< By radar of the configuration.
    std::string problem;                               ///< Why the file is not used; empty: it is.
    std::vector<std::string> passed_over;              ///< Radars whose mount changed.
    bool is_foreign = false;                           ///< Not used, and not of cremed.
  };
  [[nodiscard]] Content parse(std::string_view toml) const;
  /// Reads the file; empty if it does not exist.
  [[nodiscard]] Content read() const;
  /// Throws UsageError if the file is another's: it would be overwritten. One of cremed that was
  /// damaged, as by a loss of power, is not.
  void refuse_foreign() const;
  /// As read(), and logs the result.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> read_and_log() const;

  /// The text to write; nothing if nothing was learned. Omits radars whose mount is wrong rather
  /// than inexact.
  [[nodiscard]] std::optional<std::string> text(
      std::span<const std::optional<LearnedErrors>> learned) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  void read_radar(TomlReader& reader, Content& content) const;

  struct Radar {
    std::string name;
    Pose2 mount;
    LearnedErrors errors;  ///< Of radars_: before anything is learned.
  };

  std::string path_;
  std::vector<Radar> radars_;
};

}  // namespace cremed
