// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/consent.hpp"

#include <ostream>
#include <string>

#include <unistd.h>

namespace cremed {
namespace {

/// A line, and the status if it is incomplete.
std::string read_line(int descriptor) {
  constexpr std::size_t kLongest = 80;
  std::string line;
  char c = '\0';
  while (line.size() < kLongest && ::read(descriptor, &c, 1) == 1 && c != '\n') {
    line += c;
  }
  return line;
}

}  // namespace

bool asks_consent(const Consent& consent, std::ostream& out) {
  if (consent.is_given) {
    return true;
  }
  if (::isatty(consent.terminal) == 0) {
    out << "standard input is no terminal; add --yes to give consent\n";
    return false;
  }
  out << "Send it? [y/N] " << std::flush;
  const std::string answer = read_line(consent.terminal);
  return answer == "y" || answer == "Y" || answer == "yes";
}

}  // namespace cremed
