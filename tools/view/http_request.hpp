// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cremed {

/// As much of an HTTP request as a server of fixed pages needs.
struct HttpRequest {
  enum class Status : std::uint8_t {
    incomplete,
    complete,
    bad  ///< No request of HTTP/1, or longer than a browser's.
  };
  Status status = Status::incomplete;
  std::string method;
  std::string path;  ///< As sent, without "?...".
  std::string host;
  bool has_range = false;
};

/// Of what has arrived so far, up to the empty line.
HttpRequest parse_http_request(std::string_view text);

}  // namespace cremed
