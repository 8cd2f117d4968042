// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <list>
#include <map>
#include <string>
#include <vector>

#include "daemon/process/descriptor.hpp"
#include "tools/view/heard_state.hpp"
#include "tools/view/http_connection.hpp"

namespace cremed {

struct ViewAddress {
  std::string host = "127.0.0.1";
  int port = 8408;  ///< 0: any that is free.
};

/// Shows the state to browsers: a page and its parts, which are read once, and the state as JSON.
/// Nothing but GET of these is answered, so that nothing can be changed through it. One thread,
/// and a limited number of connections, each for a limited time.
class ViewServer {
 public:
  /// `state` outlives the server. Throws std::runtime_error.
  ViewServer(const HeardState& state, const ViewAddress& address);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  /// Answers until stop().
  void run();
  /// By another thread, at any time.
  void stop() { is_stopped_ = true; }

 private:
  void read_page();
  void listen(const ViewAddress& address);
  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const;
  void wait_and_advance();
  void accept_all();

  const HeardState& state_;
  std::vector<std::string> own_names_;
  std::map<std::string, HttpResponse> pages_;  // By path.
  std::list<HttpConnection> connections_;
  Descriptor socket_;
  int port_ = 0;
  std::atomic<bool> is_stopped_{false};
};

/// The names of this computer: its own, and that of multicast DNS.
std::vector<std::string> own_host_names();

/// Whether a browser on its way to this server would say so in "Host": an address, "localhost", or
/// one of `names`. A page from elsewhere that had its own name point here (DNS rebinding) says that
/// name.
bool is_own_host(const std::string& header, const std::vector<std::string>& names);

}  // namespace cremed
