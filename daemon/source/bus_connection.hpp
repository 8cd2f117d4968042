// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/source/bus_status.hpp"
#include "daemon/source/can_socket.hpp"
#include "daemon/source/link_watch.hpp"

namespace cremed {

/// Keeps a socket on a named interface through its whole life: not there yet, down, up, down again
/// (the socket lives on), removed and made anew (the old socket would stay deaf, so a new one is
/// opened). What was interrupted resumes by itself.
class BusConnection {
 public:
  BusConnection(std::string name, std::vector<std::uint32_t> ids, const CanSocketOptions& options);

  /// To be called a few times a second: opens what is closed, and closes what is no more. `link`:
  /// the interface as it is now.
  void maintain(const Link& link);

  /// Frames that are there now, as CanSocket::receive. An interface that went down or away is
  /// noted.
  CanReceiveResult receive();

  int send(const CanFrame& frame);

  /// From now on it is this interface.
  void set_name(std::string name) { name_ = std::move(name); }
  /// Receives the frames of these identifiers too.
  void add_ids(const std::vector<std::uint32_t>& ids);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<std::uint32_t>& ids() const { return ids_; }
  [[nodiscard]] int descriptor() const { return socket_.descriptor(); }
  [[nodiscard]] BusStatus& status() { return status_; }
  [[nodiscard]] const BusStatus& status() const { return status_; }

 private:
  void open(const Link& link);
  void look(const Link& link);
  void lose(LinkState link);

  std::string name_;
  std::vector<std::uint32_t> ids_;
  CanSocketOptions options_;
  CanSocket socket_;
  BusStatus status_;
};

}  // namespace cremed
