// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Faults of an ARS408 that show in its clusters, injected into the frames of a healthy drive.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/estimator/scan/stamps.hpp"
#include "test/faults/frame_faults.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace cremed::test {

/// Whether the frame is that message of an ARS408 with sensor id 0.
inline bool is_message(const CanFrame& frame, Ars408Message message) {
  return frame.id == ars408_id(static_cast<std::uint32_t>(message), 0);
}

/// A frame with this stamp and bus.
inline CanFrame at_place_of(const CanFrame& place, CanFrame frame) {
  frame.stamp_us = place.stamp_us;
  frame.interface = place.interface;
  return frame;
}

/// `change(cluster)`, or `change(cluster, seconds since the fault's begin)`, is applied to the
/// clusters of the radars that `is_faulty` selects; values are rounded again.
template <typename Change>
Frames with_changed_clusters(Frames frames, FaultTime time, const RadarSelection& is_faulty,
                             Change change) {
  for (CanFrame& frame : frames) {
    if (!is_faulty(std::size_t{frame.interface}) || !time.has(frame) ||
        !is_message(frame, Ars408Message::cluster_general)) {
      continue;
    }
    auto cluster = decode_ars408<Ars408Cluster>(std::span(frame.data).first(frame.length));
    if (!cluster) continue;
    if constexpr (std::is_invocable_v<Change, Ars408General&, double>) {
      change(*cluster, seconds_between(time.from_us, frame.stamp_us));
    } else {
      change(*cluster);
    }
    frame.data = encode_ars408_cluster(0, *cluster).data;
  }
  return frames;
}

/// Turns position and velocity of a cluster counter-clockwise.
inline void turn(Ars408General& cluster, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  const Ars408General seen = cluster;
  cluster.x_m = c * seen.x_m - s * seen.y_m;
  cluster.y_m = s * seen.x_m + c * seen.y_m;
  cluster.vx_mps = c * seen.vx_mps - s * seen.vy_mps;
  cluster.vy_mps = s * seen.vx_mps + c * seen.vy_mps;
}

/// Adds to the velocity in the direction of view.
inline void add_doppler(Ars408General& cluster, double mps) {
  const double range_m = std::hypot(cluster.x_m, cluster.y_m);
  cluster.vx_mps += mps * cluster.x_m / range_m;
  cluster.vy_mps += mps * cluster.y_m / range_m;
}

/// An ARS408 was knocked: its direction of view turns by `yaw_rad`, so its targets turn the other
/// way.
inline Frames with_knocked_mount(Frames frames, FaultTime time, std::size_t radar, double yaw_rad) {
  return with_changed_clusters(std::move(frames), time, only(radar),
                               [yaw_rad](Ars408General& cluster) { turn(cluster, -yaw_rad); });
}

/// Mounted upside down: left and right are exchanged.
inline Frames with_upside_down(Frames frames, FaultTime time, std::size_t radar) {
  return with_changed_clusters(std::move(frames), time, only(radar), [](Ars408General& cluster) {
    cluster.y_m = -cluster.y_m;
    cluster.vy_mps = -cluster.vy_mps;
  });
}

/// Velocities of those radars are multiplied by `factor`.
inline Frames with_scaled_doppler(Frames frames, FaultTime time, const RadarSelection& is_faulty,
                                  double factor) {
  return with_changed_clusters(std::move(frames), time, is_faulty,
                               [factor](Ars408General& cluster) {
                                 cluster.vx_mps *= factor;
                                 cluster.vy_mps *= factor;
                               });
}

/// Only the clusters with `is_seen(cluster, radar)` are seen.
template <typename IsSeen>
Frames with_targets(const Frames& frames, FaultTime time, IsSeen is_seen) {
  struct List {
    std::optional<std::size_t> header;  // In the result.
    std::uint8_t near = 0;              // Number of its targets before.
    std::array<std::optional<std::uint8_t>, 256> new_id;
  };
  std::array<List, 256> lists;
  Frames result;
  for (CanFrame frame : frames) {
    List& list = lists[frame.interface];
    std::uint8_t& id = frame.data[0];
    if (is_message(frame, Ars408Message::cluster_status)) {
      list = {result.size(), std::exchange(frame.data[0], 0), {}};
      frame.data[1] = 0;
    } else if (is_message(frame, Ars408Message::cluster_general)) {
      const auto cluster = decode_ars408<Ars408Cluster>(std::span(frame.data).first(frame.length));
      if (!list.header || (cluster && time.has(frame) && !is_seen(*cluster, frame.interface))) {
        continue;
      }
      auto& header = result[*list.header].data;
      list.new_id[id] = static_cast<std::uint8_t>(header[0] + header[1]);
      ++header[id < list.near ? 0 : 1];
      id = *list.new_id[id];
    } else if (is_message(frame, Ars408Message::cluster_quality)) {
      if (!list.new_id[id]) continue;
      id = *list.new_id[id];
    }
    result.push_back(frame);
  }
  return result;
}

/// Only a share of the targets is seen, drawn anew in each scan. No fault: another sensor, or
/// surroundings with less in them.
inline Frames with_fewer_targets(const Frames& frames, double share) {
  std::mt19937_64 random(1);
  std::bernoulli_distribution is_seen(share);
  const FaultTime always{std::numeric_limits<std::int64_t>::min(),
                         std::numeric_limits<std::int64_t>::max()};
  return with_targets(frames, always,
                      [&](const Ars408General&, std::size_t) { return is_seen(random); });
}

/// Radars hang: each repeats the clusters of its last list while its counter runs on.
inline Frames with_repeated_scan(const Frames& frames, FaultTime time) {
  struct Bus {
    std::vector<CanFrame> open;  // The list that is being received.
    std::vector<CanFrame> last;  // The one before: header, clusters and their quality.
    bool hangs = false;
  };
  std::array<Bus, 256> buses;
  Arrivals arrivals;
  for (const CanFrame& frame : frames) {
    Bus& bus = buses[frame.interface];
    const bool is_header = is_message(frame, Ars408Message::cluster_status);
    const bool is_of_list = is_header || is_message(frame, Ars408Message::cluster_general) ||
                            is_message(frame, Ars408Message::cluster_quality);
    if (is_header) {
      if (!bus.hangs) bus.last = std::exchange(bus.open, {});
      bus.hangs = time.has(frame) && !bus.last.empty();
    }
    if (!is_of_list || !bus.hangs) {
      if (is_of_list) bus.open.push_back(frame);
      arrivals.add(frame.stamp_us, frame);
    } else if (is_header) {
      const std::int64_t later_us = frame.stamp_us - bus.last.front().stamp_us;
      for (CanFrame repeated : bus.last) {
        // The header's counter.
        if (is_message(repeated, Ars408Message::cluster_status)) {
          std::copy_n(&frame.data[2], 2, &repeated.data[2]);
        }
        repeated.stamp_us += later_us;
        arrivals.add(repeated.stamp_us, repeated);
      }
    }
  }
  return arrivals.in_order();
}

}  // namespace cremed::test
