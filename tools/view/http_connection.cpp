// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/http_connection.hpp"

#include <array>
#include <cerrno>

#include <poll.h>
#include <sys/socket.h>

namespace cremed {
namespace {

constexpr std::chrono::seconds kLongest{10};
/// Nothing comes from elsewhere, and nobody frames the page.
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'";

const char* reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 416:
      return "Range Not Satisfiable";
    case 503:
      return "Service Unavailable";
    default:
      return "Bad Request";
  }
}

bool would_block() { return errno == EAGAIN || errno == EINTR; }

}  // namespace

HttpConnection::HttpConnection(int socket, Clock::time_point now)
    : socket_(socket), deadline_(now + kLongest) {}

short HttpConnection::events() const { return step_ == Step::response ? POLLOUT : POLLIN; }

void HttpConnection::refuse(const HttpResponse& response) {
  begin_response(response);
  write();
}

void HttpConnection::advance(const Answer& answer) {
  if (step_ == Step::response) {
    write();
  } else {
    read(answer);
  }
}

void HttpConnection::read(const Answer& answer) {
  std::array<char, 4096> part;
  const ssize_t count = ::recv(socket(), part.data(), part.size(), 0);
  if (count <= 0) {
    step_ = count < 0 && would_block() ? step_ : Step::over;
    return;
  }
  if (step_ == Step::end) {  // What comes after the request, for nobody.
    return;
  }
  request_.append(part.data(), static_cast<std::size_t>(count));
  const HttpRequest request = parse_http_request(request_);
  if (request.status != HttpRequest::Status::incomplete) {
    begin_response(answer(request));
    write();
  }
}

void HttpConnection::begin_response(const HttpResponse& response) {
  step_ = Step::response;
  response_ = "HTTP/1.1 " + std::to_string(response.status) + " " + reason_of(response.status) +
              "\r\nContent-Type: " + response.type +
              "\r\nContent-Length: " + std::to_string(response.content.size()) +
              "\r\nConnection: close\r\nCache-Control: no-store\r\nAccept-Ranges: none"
              "\r\nX-Content-Type-Options: nosniff\r\nContent-Security-Policy: " +
              kPolicy + (response.status == 405 ? "\r\nAllow: GET" : "") +
              (response.status == 503 ? "\r\nRetry-After: 5" : "") + "\r\n\r\n" + response.content;
}

void HttpConnection::write() {
  while (sent_ < response_.size()) {
    const ssize_t count =
        ::send(socket(), &response_[sent_], response_.size() - sent_, MSG_NOSIGNAL);
    if (count < 0) {
      step_ = would_block() ? step_ : Step::over;
      return;
    }
    sent_ += static_cast<std::size_t>(count);
  }
  // The other end closes first: what it still sends would make the kernel discard the answer.
  ::shutdown(socket(), SHUT_WR);
  step_ = Step::end;
}

}  // namespace cremed
