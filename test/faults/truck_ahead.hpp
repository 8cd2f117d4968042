// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cremed/can_decoders/ars408_signals.hpp"
#include "test/faults/cluster_faults.hpp"

namespace cremed::test {

/// A truck ahead of an ARS408 that moves along, flagged stationary: clusters behind it become
/// clusters of it, at rest relative to the radar, and others are added until it has `count`, fewer
/// where a list would be too long.
class TruckAhead {
 public:
  TruckAhead(FaultTime time, std::size_t radar, std::size_t count)
      : time_(time), radar_(radar), count_(count) {}

  [[nodiscard]] Frames in(const Frames& frames) {
    Frames result;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const CanFrame& frame = frames[i];
      if (frame.interface != radar_) {
        result.push_back(frame);
      } else if (is_message(frame, Ars408Message::cluster_status)) {
        result.push_back(begin(std::span(frames).subspan(i)));
        add_when_due(frame, result);
      } else if (is_message(frame, Ars408Message::cluster_general)) {
        result.push_back(
            is_in_list_ && is_hidden(frame) ? at_place_of(frame, cluster(frame.data[0])) : frame);
      } else {
        result.push_back(frame);
        qualities_ += is_message(frame, Ars408Message::cluster_quality) ? 1 : 0;
        add_when_due(frame, result);
      }
    }
    return result;
  }

 private:
  static constexpr std::size_t kMostClusters = 250;
  static constexpr double kTailM = 8.0;
  static constexpr double kLengthM = 12.0;
  static constexpr double kHalfWidthM = 1.3;

  static bool is_hidden(const CanFrame& frame) {
    const auto seen = decode_ars408<Ars408Cluster>(std::span(frame.data).first(frame.length));
    return seen && seen->x_m > kTailM && std::abs(seen->y_m) < kHalfWidthM / kTailM * seen->x_m;
  }

  /// The header of the list that begins there, with the number of its clusters.
  CanFrame begin(std::span<const CanFrame> frames) {
    const CanFrame& header = frames.front();
    auto status = decode_ars408<Ars408ClusterStatus>(std::span(header.data).first(header.length));
    added_ = 0;
    is_in_list_ = time_.has(header) && status;
    if (!is_in_list_) return header;
    own_ = std::size_t{status->near_count} + status->far_count;
    qualities_ = 0;
    std::size_t hidden = 0;
    for (const CanFrame& frame : frames.subspan(1)) {
      if (frame.interface != radar_) continue;
      if (is_message(frame, Ars408Message::cluster_status)) break;
      hidden += is_message(frame, Ars408Message::cluster_general) && is_hidden(frame) ? 1 : 0;
    }
    added_ =
        std::min(count_ - std::min(count_, hidden), kMostClusters - std::min(kMostClusters, own_));
    status->near_count = static_cast<std::uint8_t>(status->near_count + added_);
    return at_place_of(header, encode_ars408(0, *status));
  }

  /// Of the tail, sides or wheels.
  CanFrame cluster(std::uint8_t id) {
    Ars408General cluster;
    cluster.id = id;
    cluster.x_m = kTailM + std::fmod(0.6180 * id, 1.0) * kLengthM + 0.1 * random_.normal();
    cluster.y_m = kHalfWidthM * std::sin(2.4 * id) + 0.1 * random_.normal();
    cluster.dyn_prop = Ars408DynProp::stationary;
    return encode_ars408_cluster(0, cluster);
  }

  /// After the list's own messages.
  void add_when_due(const CanFrame& place, Frames& result) {
    if (qualities_ != own_) return;
    for (std::size_t i = 0; i < added_; ++i) {
      Ars408ClusterQuality quality;
      quality.id = static_cast<std::uint8_t>(own_ + i);
      quality.rms = {ars408_rms_code(0.2), ars408_rms_code(0.3), ars408_rms_code(0.3),
                     ars408_rms_code(0.01)};
      quality.false_alarm_code = 1;
      quality.ambiguity = Ars408Ambiguity::unambiguous;
      result.push_back(at_place_of(place, cluster(quality.id)));
      result.push_back(at_place_of(place, encode_ars408(0, quality)));
    }
    added_ = 0;
  }

  FaultTime time_;
  std::size_t radar_;
  std::size_t count_;
  Random random_{1, kFaultStream};
  bool is_in_list_ = false;    // The open list has the truck.
  std::size_t own_ = 0;        // Clusters of the radar in the open list.
  std::size_t qualities_ = 0;  // Of these, those that are complete.
  std::size_t added_ = 0;      // The truck's that are due.
};

}  // namespace cremed::test
