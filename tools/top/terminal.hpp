// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <termios.h>

#include "tools/top/screen.hpp"

namespace cremed {

/// The terminal on standard input and output, as a screen of its own while this lives; what was on
/// it before comes back. Keys are read without Enter and not shown.
class Terminal {
 public:
  /// Throws std::runtime_error if there is none.
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Cuts what does not fit.
  void show(const std::vector<ScreenLine>& lines);
  /// Whether q was pressed, or no key can come any more. Does not wait.
  [[nodiscard]] static bool is_quit_asked();

 private:
  termios before_{};
};

}  // namespace cremed
