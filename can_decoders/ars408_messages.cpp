// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_messages.hpp"

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {

// For users of the library, which has no header of the signals.
template std::optional<Ars408RadarState> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408Version> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408FilterState> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408ClusterStatus> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408Cluster> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408ClusterQuality> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408ObjectStatus> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408Object> decode_ars408(Ars408Bytes bytes);
template std::optional<Ars408ObjectQuality> decode_ars408(Ars408Bytes bytes);

}  // namespace cremed
