// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/lcm_url.hpp"

#include <string>

#include <arpa/inet.h>

#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

bool is_integer(std::string_view text, int min, int max) {
  const auto value = whole_number<int>(text);
  return value && *value >= min && *value <= max;
}

/// Returns the text before the separator and leaves the text after it.
std::string_view take_until(char separator, std::string_view& text) {
  const std::size_t end = text.find(separator);
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return taken;
}

bool is_group(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1 && IN_MULTICAST(ntohl(address.s_addr));
}

/// "239.255.76.67:7667?ttl=0"; each part is optional.
bool is_multicast(std::string_view text) {
  std::string_view address = take_until('?', text);
  const bool has_port = address.find(':') != std::string_view::npos;
  const std::string group(take_until(':', address));
  bool is_good = (group.empty() || is_group(group)) && (!has_port || is_integer(address, 1, 65535));
  while (!text.empty()) {
    std::string_view value = take_until('&', text);
    const std::string_view key = take_until('=', value);
    is_good = is_good && (key == "ttl" ? is_integer(value, 0, 255) : key == "recv_buf_size");
  }
  return is_good;
}

}  // namespace

bool is_lcm_url(std::string_view text) {
  constexpr std::string_view kMulticast = "udpm://";
  if (text.starts_with(kMulticast)) {
    return is_multicast(text.substr(kMulticast.size()));
  }
  constexpr std::string_view kFile = "file://";
  constexpr std::string_view kWritten = "?mode=w";
  if (text.starts_with(kFile)) {
    return text.size() > kFile.size() + kWritten.size() && text.ends_with(kWritten);
  }
  return text == "none" || text.starts_with("memq://");
}

}  // namespace cremed
