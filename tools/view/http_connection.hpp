// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "daemon/process/descriptor.hpp"
#include "tools/view/http_request.hpp"

namespace cremed {

struct HttpResponse {
  int status = 200;
  std::string type = "text/plain";
  std::string content;
};

/// One request and its answer, within a limited time, whatever the other end does or leaves out.
class HttpConnection {
 public:
  using Clock = std::chrono::steady_clock;
  using Answer = std::function<HttpResponse(const HttpRequest&)>;

  /// Owns the socket, which does not block. A reader slower than kLongest is cut off.
  HttpConnection(int socket, Clock::time_point now);

  [[nodiscard]] int socket() const { return socket_.number(); }
  /// What poll(2) is to wait for.
  [[nodiscard]] short events() const;
  /// Answers without hearing the request.
  void refuse(const HttpResponse& response);
  /// Reads and writes what is possible at once.
  void advance(const Answer& answer);
  [[nodiscard]] bool is_over(Clock::time_point now) const {
    return step_ == Step::over || now >= deadline_;
  }

 private:
  enum class Step : std::uint8_t { request, response, end, over };
  void read(const Answer& answer);
  void write();
  void begin_response(const HttpResponse& response);

  Descriptor socket_;
  Clock::time_point deadline_;
  Step step_ = Step::request;
  std::string request_;
  std::string response_;
  std::size_t sent_ = 0;
};

}  // namespace cremed
