// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/process/plain_text.hpp"

using namespace cremed;

TEST_CASE("What prints is left as it is") {
  const auto text = GENERATE(as<std::string>{}, "", "front: 13.6 scans/s\n", "a\tb", "caf\u00E9",
                             "\u00A0\u2192\U0001F697", "~\u0100");
  CHECK(plain_text(text) == text);
}

TEST_CASE("What a terminal would take for a command is replaced") {
  CHECK(plain_text("\x1B[31mred\x1B]0;title\x07") == "?[31mred?]0;title?");
  CHECK(plain_text("\r\b\x7F") == "???");
  CHECK(plain_text(std::string("a\0b", 3)) == "a?b");
  CHECK(plain_text("\u009B31m\u0080\u009F") == "?31m??");  // C1 in UTF-8.
  CHECK(plain_text("\x9B"
                   "31m") == "?31m");  // C1 as a byte.
  CHECK(plain_text("\xC3z\xE2\x82z\xF5\xC0\x9B\xE2") == "?z??z????");
}

TEST_CASE("The beginning of a character waits for its rest") {
  CHECK(unfinished_bytes("") == 0);
  CHECK(unfinished_bytes("a\u00E9\u2192") == 0);
  CHECK(unfinished_bytes("a\xC3") == 1);
  CHECK(unfinished_bytes("a\xE2\x86") == 2);
  CHECK(unfinished_bytes("\xF0\x9F\x9A") == 3);
  CHECK(unfinished_bytes("\x86\x86\x86\x86") == 0);
  CHECK(unfinished_bytes("a\x1B") == 0);
}
