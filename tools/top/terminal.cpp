// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/top/terminal.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "daemon/process/descriptor.hpp"

namespace cremed {
namespace {

// Of ECMA-48 and xterm: another screen without cursor; and back.
constexpr std::string_view kEnter = "\033[?1049h\033[?25l";
constexpr std::string_view kLeave = "\033[?25h\033[?1049l";
constexpr std::string_view kHome = "\033[H";
constexpr std::string_view kClearLine = "\033[K";
constexpr std::string_view kClearRest = "\033[J";
constexpr std::string_view kNoColour = "\033[0m";

std::string_view colour(Mood mood) {
  switch (mood) {
    case Mood::good:
      return "\033[32m";
    case Mood::careful:
      return "\033[33m";
    case Mood::bad:
      return "\033[31m";
    case Mood::plain:
      break;
  }
  return "";
}

/// Not through the standard streams, which take out what commands a terminal. A terminal that is
/// gone sends SIGHUP.
void write(std::string_view text) { write_all(STDOUT_FILENO, text); }

winsize size() {
  winsize told{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &told) != 0 || told.ws_col == 0 || told.ws_row == 0) {
    told.ws_col = 80;
    told.ws_row = 24;
  }
  return told;
}

}  // namespace

Terminal::Terminal() {
  if (::isatty(STDOUT_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw std::runtime_error("needs a terminal; --once prints the state once");
  }
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  // They would leave the shell on this screen.
  raw.c_cc[VSUSP] = raw.c_cc[VQUIT] = _POSIX_VDISABLE;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  write(kEnter);
}

Terminal::~Terminal() {
  write(kLeave);
  ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

void Terminal::show(const std::vector<ScreenLine>& lines) {
  const winsize room = size();
  std::string text(kHome);
  const std::size_t count = std::min<std::size_t>(lines.size(), room.ws_row);
  for (std::size_t i = 0; i < count; ++i) {
    text.append(i == 0 ? "" : "\n").append(colour(lines[i].mood));
    text.append(lines[i].text, 0, room.ws_col).append(kNoColour).append(kClearLine);
  }
  write(text.append(kClearRest));
}

bool Terminal::is_quit_asked() {
  pollfd keys{STDIN_FILENO, POLLIN, 0};
  if (::poll(&keys, 1, 0) <= 0) {
    return false;
  }
  char key = 0;
  const ssize_t got = ::read(STDIN_FILENO, &key, 1);
  return got == 0 || (got < 0 && errno != EINTR) || key == 'q' || key == 'Q';
}

}  // namespace cremed
