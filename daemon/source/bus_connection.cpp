// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/bus_connection.hpp"

#include <cerrno>
#include <utility>

namespace cremed {

BusConnection::BusConnection(std::string name, const IdSet& ids, const CanSocketOptions& options)
    : name_(std::move(name)), ids_(ids), options_(options) {
  status_.link = LinkState::absent;
}

void BusConnection::maintain(const Link& link) {
  if (socket_.is_open()) {
    look(link);
  }
  if (!socket_.is_open()) {
    open(link);
  }
}

void BusConnection::adopt(int descriptor) {
  status_.receive_buffer_bytes = socket_.adopt(descriptor, options_).receive_buffer_bytes;
  status_.link = LinkState::up;
}

void BusConnection::add_ids(const IdSet& ids) {
  ids_ |= ids;
  if (socket_.is_open() && !socket_.set_ids(ids_)) {
    lose(LinkState::failed);
  }
}

void BusConnection::open(const Link& link) {
  const CanOpenResult result =
      link.error != 0 ? CanOpenResult{link.error} : socket_.open(link.index, ids_, options_);
  status_.error = result.error;
  if (result.error != 0) {
    const bool is_absent = link.error == 0 && is_interface_gone(result.error);
    status_.link = is_absent ? LinkState::absent : LinkState::failed;
    return;
  }
  status_.receive_buffer_bytes = result.receive_buffer_bytes;
  status_.bus = BusState::error_active;
  status_.link = link.is_up ? LinkState::up : LinkState::down;
}

void BusConnection::look(const Link& link) {
  status_.hardware_stamps_work = socket_.hardware_stamps_work();
  if (link.error != 0) {
    return;  // An open socket may still work.
  }
  if (link.index != socket_.interface_index()) {
    lose(LinkState::absent);
  } else if (link.is_up) {
    status_.link = LinkState::up;
  } else if (status_.link == LinkState::up) {
    lose(LinkState::down);
  }
}

/// After LinkState::down the same socket works again; after others it never does. The controller
/// starts again as error active, and sends no error frame that says so.
void BusConnection::lose(LinkState link) {
  status_.interruptions += status_.link == LinkState::up ? 1 : 0;
  status_.link = link;
  status_.bus = BusState::error_active;
  if (link != LinkState::down) {
    socket_.close();
  }
}

CanReceiveResult BusConnection::receive() {
  if (!socket_.is_open()) {
    return {};  // Closed since poll().
  }
  const CanReceiveResult result = socket_.receive();
  if (result.error == ENETDOWN) {
    lose(LinkState::down);
  } else if (is_interface_gone(result.error)) {
    lose(LinkState::absent);
  } else if (result.error != 0) {
    status_.error = result.error;
    lose(LinkState::failed);
  }
  return result;
}

int BusConnection::send(const CanFrame& frame) {
  const int error = socket_.is_open() ? socket_.send(frame) : ENODEV;
  ++(error == 0 ? status_.frames_sent : status_.send_failures);
  return error;
}

}  // namespace cremed
