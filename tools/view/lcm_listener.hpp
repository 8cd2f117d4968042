// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include <lcm/lcm.h>

#include "tools/view/heard_state.hpp"

namespace cremed {

/// Receives cremed's messages over LCM. Publishes nothing.
class LcmListener {
 public:
  /// Throws std::runtime_error with what is wrong and how to mend it.
  LcmListener(const std::string& url, HeardState& state);

  /// Waits for messages and takes them; returns after 0.1 s without. False at the end of a log
  /// (file://), after which nothing comes any more.
  bool listen();

 private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  std::unique_ptr<lcm_t, Destroy> lcm_;
};

}  // namespace cremed
