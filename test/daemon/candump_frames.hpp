// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

// In the type's own namespace, where Catch looks for it.
inline bool operator==(const CanFrame& a, const CanFrame& b) {
  return a.stamp_us == b.stamp_us && a.id == b.id && a.interface == b.interface &&
         a.length == b.length && a.extended == b.extended && a.remote == b.remote &&
         a.error == b.error && a.fd == b.fd && a.data == b.data;
}

inline const std::string kHead = "(1436509052.249713) can0 ";

enum class Kind { standard, extended, remote, extended_remote, error, fd, extended_fd };

inline CanFrame make_frame(Kind kind, std::uint32_t id,
                           std::initializer_list<std::uint8_t> bytes = {}) {
  CanFrame frame;
  frame.id = id;
  frame.stamp_us = 1436509052249713;
  frame.extended =
      kind == Kind::extended || kind == Kind::extended_remote || kind == Kind::extended_fd;
  frame.remote = kind == Kind::remote || kind == Kind::extended_remote;
  frame.error = kind == Kind::error;
  frame.fd = kind == Kind::fd || kind == Kind::extended_fd;
  for (const std::uint8_t byte : bytes) {
    frame.data[frame.length++] = byte;
  }
  return frame;
}

inline CanFrame with_length(CanFrame frame, std::uint8_t length) {
  frame.length = length;
  return frame;
}

}  // namespace cremed
