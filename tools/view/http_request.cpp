// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/http_request.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace cremed {
namespace {

constexpr std::size_t kLongestRequest = 8192;
constexpr std::string_view kLineEnd = "\r\n";
constexpr std::string_view kEnd = "\r\n\r\n";

/// Takes the text before the separator, and the separator.
std::string_view take_until(std::string_view separator, std::string_view& text) {
  const std::size_t end = text.find(separator);
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + separator.size());
  return taken;
}

bool is_named(std::string_view name, std::string_view lower) {
  return std::equal(name.begin(), name.end(), lower.begin(), lower.end(), [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
}

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

}  // namespace

HttpRequest parse_http_request(std::string_view text) {
  HttpRequest request;
  const std::size_t end = text.find(kEnd);
  if (end > kLongestRequest) {  // Or there is none.
    request.status =
        text.size() > kLongestRequest ? HttpRequest::Status::bad : HttpRequest::Status::incomplete;
    return request;
  }
  text = text.substr(0, end);
  std::string_view line = take_until(kLineEnd, text);
  request.method = take_until(" ", line);
  std::string_view target = take_until(" ", line);
  request.path = take_until("?", target);
  while (!text.empty()) {
    std::string_view value = take_until(kLineEnd, text);
    const std::string_view name = take_until(":", value);
    if (is_named(name, "host")) {
      request.host = without_blanks(value);
    }
    request.has_range = request.has_range || is_named(name, "range");
  }
  const bool is_good = line.starts_with("HTTP/1.") && request.path.starts_with('/');
  request.status = is_good ? HttpRequest::Status::complete : HttpRequest::Status::bad;
  return request;
}

}  // namespace cremed
