// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_messages.hpp"

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {

using ars408_signals::decoded;

std::optional<Ars408ClusterStatus> decode_ars408_cluster_status(Ars408Bytes bytes) {
  return decoded<Ars408ClusterStatus>(Ars408Message::cluster_status, bytes);
}

std::optional<Ars408ObjectStatus> decode_ars408_object_status(Ars408Bytes bytes) {
  return decoded<Ars408ObjectStatus>(Ars408Message::object_status, bytes);
}

std::optional<Ars408General> decode_ars408_cluster_general(Ars408Bytes bytes) {
  return decoded<ars408_signals::Cluster>(Ars408Message::cluster_general, bytes);
}

std::optional<Ars408General> decode_ars408_object_general(Ars408Bytes bytes) {
  return decoded<ars408_signals::Object>(Ars408Message::object_general, bytes);
}

std::optional<Ars408ClusterQuality> decode_ars408_cluster_quality(Ars408Bytes bytes) {
  return decoded<Ars408ClusterQuality>(Ars408Message::cluster_quality, bytes);
}

std::optional<Ars408ObjectQuality> decode_ars408_object_quality(Ars408Bytes bytes) {
  return decoded<Ars408ObjectQuality>(Ars408Message::object_quality, bytes);
}

std::optional<Ars408RadarState> decode_ars408_radar_state(Ars408Bytes bytes) {
  return decoded<Ars408RadarState>(Ars408Message::radar_state, bytes);
}

std::optional<Ars408FilterState> decode_ars408_filter_state(Ars408Bytes bytes) {
  return decoded<Ars408FilterState>(Ars408Message::filter_state, bytes);
}

}  // namespace cremed
