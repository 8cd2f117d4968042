// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <type_traits>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/bit_field.hpp"

namespace cremed {

/// What `read` takes from the payload of a message; nothing if that is too short.
template <typename Read>
std::optional<std::invoke_result_t<Read, PayloadBits>> decoded(Ars408Message message,
                                                               Ars408Bytes bytes, Read read) {
  const bool is_whole =
      std::any_of(kArs408Messages.begin(), kArs408Messages.end(), [&](const Ars408MessageRow& row) {
        return row.message == message && bytes.size() >= row.length;
      });
  return is_whole ? std::optional(read(PayloadBits::big_endian(bytes))) : std::nullopt;
}

}  // namespace cremed
