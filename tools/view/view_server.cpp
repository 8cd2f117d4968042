// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/view_server.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>

namespace cremed {
namespace {

constexpr std::size_t kMostRequests = 1000;  // On one connection.
constexpr int kForbidden = 403;
constexpr int kNotFound = 404;
constexpr int kMethodNotAllowed = 405;
/// Nothing comes from elsewhere, and nobody frames the page.
constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; "
    "frame-ancestors 'none'";

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

/// Without port and brackets: of "127.0.0.1:8408", "[::1]:8408".
std::string host_of(const std::string& header) {
  const std::size_t end = header.find(']');
  if (header.starts_with('[') && end != std::string::npos) {
    return header.substr(1, end - 1);
  }
  return header.substr(0, header.find(':'));
}

/// The library takes paths as regular expressions.
std::string pattern_of(std::string path) {
  for (std::size_t i = path.find('.'); i != std::string::npos; i = path.find('.', i + 3)) {
    path.replace(i, 1, "[.]");
  }
  return path;
}

/// As the library's own, but that two may not share a port: the second would wait for ever.
void set_socket_options(int socket) {
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

void refuse(httplib::Response& response, int status, const std::string& reason) {
  response.status = status;
  response.set_content(reason + "\n", "text/plain");
}

/// The library would compress other content, for longer than it takes to make this one.
void send_as_it_is(std::string json, httplib::Response& response) {
  const std::size_t size = json.size();
  response.set_content_provider(
      size, "application/json",
      [json = std::move(json)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(json.data() + offset, length);
      });
}

}  // namespace

bool is_own_host(const std::string& header, const std::string& host) {
  const std::string name = host_of(header);
  return is_address(name) || name == "localhost" || name == host;
}

ViewServer::ViewServer(const HeardState& state, const ViewAddress& address)
    : server_(std::make_unique<httplib::Server>()) {
  refuse_what_is_not_ours(address.host);
  serve_page();
  server_->Get(pattern_of("/state.json"),
               [&state](const auto&, auto& response) { send_as_it_is(state.json(), response); });
  bind(address);
}

void ViewServer::refuse_what_is_not_ours(const std::string& own_host) {
  server_->set_keep_alive_max_count(kMostRequests);
  server_->set_payload_max_length(0);
  server_->set_default_headers({{"Content-Security-Policy", kPolicy},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Cache-Control", "no-store"}});
  server_->set_pre_routing_handler([own_host](const auto& request, auto& response) {
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      refuse(response, kMethodNotAllowed, "only GET: nothing can be changed here");
    } else if (!is_own_host(request.get_header_value("Host"), own_host)) {
      refuse(response, kForbidden, "Host must be this computer's address or localhost");
    } else {
      return httplib::Server::HandlerResponse::Unhandled;
    }
    return httplib::Server::HandlerResponse::Handled;
  });
  server_->set_error_handler([](const auto&, auto& response) {
    if (response.status == kNotFound) {
      refuse(response, kNotFound, "there is no such page");
    }
  });
}

void ViewServer::serve_page() {
  constexpr const char* kScript = "text/javascript";
  const std::filesystem::path ours = shared_folder();
  const std::filesystem::path dygraphs = "/usr/share/javascript/dygraphs";
  serve("/", "text/html", content_of(ours / "view.html", "cremed-tools"));
  serve("/view.js", kScript, content_of(ours / "view.js", "cremed-tools"));
  serve("/charts.js", kScript, content_of(ours / "charts.js", "cremed-tools"));
  serve("/style.css", "text/css", content_of(ours / "style.css", "cremed-tools"));
  serve("/dygraph.min.js", kScript, content_of(dygraphs / "dygraph.min.js", "libjs-dygraphs"));
  serve("/dygraph.min.css", "text/css", content_of(dygraphs / "dygraph.min.css", "libjs-dygraphs"));
}

void ViewServer::bind(const ViewAddress& address) {
  server_->set_socket_options(set_socket_options);
  const bool is_any = address.port == 0;
  port_ = is_any ? server_->bind_to_any_port(address.host) : address.port;
  if (port_ < 0 || (!is_any && !server_->bind_to_port(address.host, port_))) {
    throw std::runtime_error("cannot listen on " + address.host + " port " +
                             std::to_string(address.port) +
                             ": is another cremed-view running? --port says another");
  }
}

ViewServer::~ViewServer() = default;

void ViewServer::serve(const std::string& path, const std::string& type, std::string content) {
  server_->Get(pattern_of(path), [type, content = std::move(content)](const auto&, auto& response) {
    response.set_content(content, type);
  });
}

void ViewServer::run() { server_->listen_after_bind(); }

void ViewServer::stop() { server_->stop(); }

}  // namespace cremed
