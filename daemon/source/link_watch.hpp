// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// State of a network interface.
struct Link {
  unsigned index = 0;  ///< 0: no interface of this name. A recreated one gets another index.
  bool is_up = false;
  int error = 0;  ///< errno of a failed query; all else is then unknown.
  bool is_can = false;
  bool has_carrier = false;  ///< Drivers drop it when their controller goes bus-off.
};

/// Follows network interfaces by kernel notifications (rtnetlink(7)). A lookup by name
/// (if_nametoindex, SIOCGIFINDEX) would make the kernel search for a module of that name, a quarter
/// of a second for each absent interface.
class LinkWatch {
 public:
  LinkWatch();

  /// Processes the notifications since the last call; does not block.
  void update();

  [[nodiscard]] Link link(std::string_view name) const;
  /// Names of the CAN interfaces, up or not, in the kernel's order.
  [[nodiscard]] std::vector<std::string> can_names() const;

 private:
  struct NamedLink {
    std::string name;
    Link link;
  };
  void open();
  void request_all();
  void fail();
  void take(const char* messages, std::size_t size);
  void note(const NamedLink& link, bool is_there);

  std::vector<NamedLink> links_;
  int error_ = 0;
  std::vector<char> buffer_;
  Descriptor descriptor_;
};

}  // namespace cremed
