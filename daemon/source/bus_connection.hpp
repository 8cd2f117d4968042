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

/// Keeps a socket on a named interface, which may be absent, down, up again (the socket survives),
/// or removed and recreated (the old socket would receive nothing, so a new one is opened).
/// Reception resumes automatically.
class BusConnection {
 public:
  BusConnection(std::string name, const IdSet& ids, const CanSocketOptions& options);

  /// Opens and closes the socket as needed; call a few times a second. `link`: present state of the
  /// interface.
  void maintain(const Link& link);

  /// For tests without CAN: as CanSocket::adopt.
  void adopt(int descriptor);

  /// Frames available now, as CanSocket::receive. Notes an interface that went down or was removed.
  CanReceiveResult receive();

  int send(const CanFrame& frame);

  /// Changes the interface.
  void set_name(std::string name) { name_ = std::move(name); }
  /// Also receives frames with these identifiers.
  void add_ids(const IdSet& ids);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const IdSet& ids() const { return ids_; }
  [[nodiscard]] int descriptor() const { return socket_.descriptor(); }
  [[nodiscard]] BusStatus& status() { return status_; }
  [[nodiscard]] const BusStatus& status() const { return status_; }

 private:
  void open(const Link& link);
  void look(const Link& link);
  void lose(LinkState link);

  std::string name_;
  IdSet ids_;
  CanSocketOptions options_;
  CanSocket socket_;
  BusStatus status_;
};

}  // namespace cremed
