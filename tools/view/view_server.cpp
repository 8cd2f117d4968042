// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/view_server.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cremed {
namespace {

constexpr int kTickMs = 100;
constexpr int kBacklog = 16;
/// That are answered. As many more are told that there are too many; others wait to be accepted.
constexpr std::size_t kMostConnections = 32;

/// As installed, and in a build.
std::filesystem::path shared_folder() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return program.parent_path().parent_path() / "share/cremed/view";
}

std::string content_of(const std::filesystem::path& path, const std::string& package) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw std::runtime_error("cannot read " + path.string() + ": install " + package);
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool is_address(const std::string& text) {
  in6_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1 ||
         ::inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return text;
}

/// Without port and brackets: of "127.0.0.1:8408", "[::1]:8408".
std::string host_of(const std::string& header) {
  const std::size_t end = header.find(']');
  if (header.starts_with('[') && end != std::string::npos) {
    return header.substr(1, end - 1);
  }
  return lower(header.substr(0, header.find(':')));
}

HttpResponse refusal(int status, const std::string& reason) {
  return {status, "text/plain", reason + "\n"};
}

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

std::runtime_error cannot_listen(const ViewAddress& address, const std::string& reason) {
  return std::runtime_error("cannot listen on " + address.host + " port " +
                            std::to_string(address.port) + ": " + reason);
}

/// Throws std::runtime_error.
Addresses addresses_of(const ViewAddress& address) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  if (const int error = ::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found)) {
    throw cannot_listen(address, std::string(::gai_strerror(error)) +
                                     "; --address must be one of this computer, or its name");
  }
  return {found, &::freeaddrinfo};
}

std::string text_of(int error) {
  switch (error) {
    case EADDRINUSE:
      return "it is in use: is another cremed-view running? --port says another";
    case EACCES:
      return "not permitted: ports below 1024 are root's; --port says another";
    case EADDRNOTAVAIL:
      return "this computer has no such address; `ip address` lists those it has";
    default:
      return std::strerror(error);
  }
}

/// Not open, with errno, if not possible.
Descriptor listening_socket(const addrinfo& address) {
  Descriptor socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int yes = 1;
  const bool listens =
      socket.is_open() &&
      ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) == 0 &&
      ::bind(socket.number(), address.ai_addr, address.ai_addrlen) == 0 &&
      ::listen(socket.number(), kBacklog) == 0;
  return listens ? std::move(socket) : Descriptor();
}

int port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  sockaddr_in6 in{};  // The port is where sockaddr_in has it.
  static_assert(offsetof(sockaddr_in6, sin6_port) == offsetof(sockaddr_in, sin_port));
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  std::memcpy(&in, &address, sizeof(in));
  return ntohs(in.sin6_port);
}

}  // namespace

std::vector<std::string> own_host_names() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  ::gethostname(name.data(), name.size() - 1);
  const std::string own = lower(name.data());
  const std::string first = own.substr(0, own.find('.'));
  return own.empty() ? std::vector<std::string>() : std::vector{own, first, first + ".local"};
}

bool is_own_host(const std::string& header, const std::vector<std::string>& names) {
  const std::string name = host_of(header);
  return is_address(name) || name == "localhost" || std::ranges::find(names, name) != names.end();
}

ViewServer::ViewServer(const HeardState& state, const ViewAddress& address)
    : state_(state), own_names_(own_host_names()) {
  own_names_.push_back(lower(address.host));
  read_page();
  listen(address);
}

void ViewServer::read_page() {
  constexpr const char* kScript = "text/javascript";
  const std::filesystem::path ours = shared_folder();
  const std::filesystem::path dygraphs = "/usr/share/javascript/dygraphs";
  const auto add = [&](const std::string& path, const char* type, const std::string& content) {
    pages_[path] = {200, type, content};
  };
  add("/", "text/html", content_of(ours / "view.html", "cremed-tools"));
  add("/view.js", kScript, content_of(ours / "view.js", "cremed-tools"));
  add("/charts.js", kScript, content_of(ours / "charts.js", "cremed-tools"));
  add("/style.css", "text/css", content_of(ours / "style.css", "cremed-tools"));
  add("/dygraph.min.js", kScript, content_of(dygraphs / "dygraph.min.js", "libjs-dygraphs"));
  add("/dygraph.min.css", "text/css", content_of(dygraphs / "dygraph.min.css", "libjs-dygraphs"));
}

void ViewServer::listen(const ViewAddress& address) {
  const Addresses addresses = addresses_of(address);
  for (const addrinfo* one = addresses.get(); one != nullptr && !socket_.is_open();
       one = one->ai_next) {
    socket_ = listening_socket(*one);
  }
  if (!socket_.is_open()) {
    throw cannot_listen(address, text_of(errno));
  }
  port_ = port_of(socket_.number());
}

HttpResponse ViewServer::answer(const HttpRequest& request) const {
  if (request.status == HttpRequest::Status::bad) {
    return refusal(400, "this is no request of a browser");
  }
  if (request.method != "GET") {
    return refusal(405, "only GET: nothing can be changed here");
  }
  if (!is_own_host(request.host, own_names_)) {
    return refusal(403, "Host must be this computer's address, its name or localhost");
  }
  if (request.has_range) {
    return refusal(416, "no ranges: pages are sent as a whole");
  }
  if (request.path == "/state.json") {
    return {200, "application/json", state_.json()};
  }
  const auto page = pages_.find(request.path);
  return page != pages_.end() ? page->second : refusal(404, "there is no such page");
}

void ViewServer::run() {
  while (!is_stopped_) {
    wait_and_advance();
    const auto now = HttpConnection::Clock::now();
    connections_.remove_if([&](const HttpConnection& one) { return one.is_over(now); });
    if (connections_.size() < 2 * kMostConnections) {
      accept_all();
    }
  }
}

void ViewServer::wait_and_advance() {
  std::vector<pollfd> waits;
  for (const HttpConnection& connection : connections_) {
    waits.push_back({connection.socket(), connection.events(), 0});
  }
  if (connections_.size() < 2 * kMostConnections) {
    waits.push_back({socket_.number(), POLLIN, 0});
  }
  if (::poll(waits.data(), waits.size(), kTickMs) <= 0) {
    return;
  }
  auto wait = waits.begin();
  for (HttpConnection& connection : connections_) {
    if ((wait++)->revents != 0) {
      connection.advance([this](const HttpRequest& request) { return answer(request); });
    }
  }
}

void ViewServer::accept_all() {
  while (connections_.size() < 2 * kMostConnections) {
    const int socket = ::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (socket < 0) {
      return;
    }
    connections_.emplace_back(socket, HttpConnection::Clock::now());
    if (connections_.size() > kMostConnections) {
      connections_.back().refuse(refusal(503, "too many connections at once"));
    }
  }
}

}  // namespace cremed
