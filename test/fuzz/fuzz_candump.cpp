// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arbitrary bytes as one line of a log: no crash, and a frame that was read is written and read
// back unchanged.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "daemon/source/candump.hpp"

namespace {

using namespace cremed;

void check(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_same(const CandumpLine& a, const CandumpLine& b) {
  check(a.status == b.status && a.interface_name == b.interface_name);
  check(a.frame.stamp_us == b.frame.stamp_us && a.frame.id == b.frame.id);
  check(a.frame.extended == b.frame.extended && a.frame.remote == b.frame.remote);
  check(a.frame.error == b.frame.error && a.frame.fd == b.frame.fd);
  check(a.frame.length == b.frame.length && a.frame.data == b.frame.data);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const CandumpLine line = parse_candump_line({reinterpret_cast<const char*>(data), size});
  check((line.status == CandumpStatus::malformed) == !line.error.empty());
  check((line.status == CandumpStatus::dropped) || line.dropped_frames == 0);
  if (line.status == CandumpStatus::frame) {
    const std::string text = candump_line(line.frame, line.interface_name);
    check_same(line, parse_candump_line(text));
  }
  return 0;
}
