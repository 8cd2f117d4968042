// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <any>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cremed/can_decoders/id_set.hpp"
#include "cremed/can_decoders/radar_decoder.hpp"

namespace cremed {

struct RadarFamily;

/// The settings of one radar: the options of its family, for example Ars408Options. A type is the
/// options of a family if this is declared beside it:
///
///     const RadarFamily& family_of(const Ars408Options&);
class RadarSettings {
 public:
  /// Implicit: settings hold nothing but the options.
  template <typename Options>
  requires requires(const Options& options) {
    { family_of(options) } -> std::same_as<const RadarFamily&>;
  }
  RadarSettings(Options options)  // NOLINT(google-explicit-constructor)
      : family_(&family_of(options)), options_(std::move(options)) {}

  [[nodiscard]] const RadarFamily& family() const { return *family_; }

  // The functions of the family's row, applied to this radar.
  [[nodiscard]] std::unique_ptr<RadarDecoder> make_decoder() const;
  [[nodiscard]] IdSet sent_ids() const;
  [[nodiscard]] IdSet obeyed_ids() const;
  [[nodiscard]] std::optional<double> rotation_lead_s() const;
  [[nodiscard]] std::string label() const;
  [[nodiscard]] std::string describe() const;
  /// The same, with the name of `wanted`'s family if the two cannot be distinguished on a bus.
  [[nodiscard]] std::string describe_to(const RadarSettings& wanted) const;
  [[nodiscard]] std::string key() const;

  /// Whether both are the same radar if they are on one bus. Options that only select targets are
  /// ignored.
  [[nodiscard]] bool is_same_radar(const RadarSettings& other) const;

  /// Null if the options are of another family.
  template <typename Options>
  [[nodiscard]] const Options* as() const {
    return std::any_cast<Options>(&options_);
  }
  template <typename Options>
  [[nodiscard]] Options* as() {
    return std::any_cast<Options>(&options_);
  }

 private:
  const RadarFamily* family_;
  std::any options_;
};

}  // namespace cremed
