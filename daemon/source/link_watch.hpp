// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cremed {

/// A network interface as the kernel knows it.
struct Link {
  unsigned index = 0;  ///< 0: there is none of this name. One that is made anew gets another.
  bool is_up = false;
  int error = 0;  ///< errno, if the kernel cannot be asked; then nothing else is known.
};

/// Follows network interfaces by the kernel's own notifications (rtnetlink(7)). To look an
/// interface up by name (if_nametoindex, SIOCGIFINDEX) would let the kernel search for a module of
/// that name, a quarter of a second each time for one that is absent.
class LinkWatch {
 public:
  LinkWatch();
  ~LinkWatch();
  LinkWatch(const LinkWatch&) = delete;
  LinkWatch& operator=(const LinkWatch&) = delete;

  /// Takes in what the kernel has told since the last call; does not wait.
  void update();

  [[nodiscard]] Link link(std::string_view name) const;
  /// Names of the CAN interfaces that are up.
  [[nodiscard]] std::vector<std::string> up_can_names() const;

 private:
  struct NamedLink {
    std::string name;
    Link link;
    bool is_can = false;
  };
  void open();
  void request_all();
  void fail();
  void take(const char* messages, std::size_t size);
  void note(const NamedLink& link, bool is_there);

  std::vector<NamedLink> links_;
  int error_ = 0;
  std::vector<char> buffer_;
  int descriptor_ = -1;
};

}  // namespace cremed
