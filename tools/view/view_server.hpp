// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "tools/view/heard_state.hpp"

namespace httplib {
class Server;
}

namespace cremed {

struct ViewAddress {
  std::string host = "127.0.0.1";
  int port = 8408;  ///< 0: any that is free.
};

/// Shows the state to browsers: a page and its parts, which are read once, and the state as JSON.
/// Nothing but GET of these is answered, so that nothing can be changed through it.
class ViewServer {
 public:
  /// `state` outlives the server. Throws std::runtime_error.
  ViewServer(const HeardState& state, const ViewAddress& address);
  ~ViewServer();

  [[nodiscard]] int port() const { return port_; }
  /// Answers until stop().
  void run();
  void stop();

 private:
  void refuse_what_is_not_ours(const std::string& own_host);
  void serve_page();
  void bind(const ViewAddress& address);
  void serve(const std::string& path, const std::string& type, std::string content);

  std::unique_ptr<httplib::Server> server_;
  int port_ = 0;
};

/// Whether a browser on its way to this server would say so in "Host": an address, "localhost", or
/// `host` itself. A page from elsewhere that had its own name point here (DNS rebinding) says that
/// name.
bool is_own_host(const std::string& header, const std::string& host);

}  // namespace cremed
