// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/process/signals.hpp"
#include "tools/program.hpp"
#include "tools/top/screen.hpp"
#include "tools/top/terminal.hpp"
#include "tools/view/heard_state.hpp"
#include "tools/view/lcm_listener.hpp"
#include "tools/view/listening.hpp"

namespace {

using Clock = std::chrono::steady_clock;

enum ExitStatus : int { good = 0, failure = 1 };

/// As fast as one reads.
constexpr std::chrono::milliseconds kPeriod{250};
constexpr std::chrono::milliseconds kPause{100};
/// A status comes once a second.
constexpr std::chrono::milliseconds kOnce{1500};

/// Hears cremed. At the end of a log nothing comes any more.
class Hearing {
 public:
  explicit Hearing(const std::string& url) : url_(url), listener_(url, state_) {}

  /// For the given time, or until it is to stop; false then.
  bool listen_for(std::chrono::milliseconds time) {
    for (const auto end = Clock::now() + time; Clock::now() < end;) {
      if (cremed::stop_requested()) {
        return false;
      }
      is_open_ = is_open_ && listener_.listen();
      if (!is_open_) {
        std::this_thread::sleep_for(kPause);
      }
    }
    return true;
  }
  [[nodiscard]] std::vector<cremed::ScreenLine> screen() const {
    std::vector<cremed::ScreenLine> lines = cremed::screen_of(state_.snapshot(), url_);
    for (const std::string& problem : problems()) {
      lines.insert(lines.begin() + 1, {problem, cremed::Mood::bad});
    }
    return lines;
  }
  /// What was heard and is not shown, or is not all.
  [[nodiscard]] std::vector<std::string> problems() const {
    std::vector<std::string> found{listener_.damage(), listener_.other_versions()};
    std::erase(found, "");
    return found;
  }
  [[nodiscard]] bool is_silent() const { return state_.snapshot()["messages"] == 0; }

 private:
  std::string url_;
  cremed::HeardState state_;
  cremed::LcmListener listener_;
  bool is_open_ = true;
};

int print_once(Hearing& hearing) {
  hearing.listen_for(kOnce);
  for (const cremed::ScreenLine& line : hearing.screen()) {
    std::cout << line.text << '\n';
  }
  return hearing.is_silent() || !hearing.problems().empty() ? failure : good;
}

int show(Hearing& hearing) {
  cremed::Terminal terminal;
  do {
    terminal.show(hearing.screen());
  } while (hearing.listen_for(kPeriod) && !cremed::Terminal::is_quit_asked());
  return good;
}

int run(CLI::App& app, int argc, char** argv) {
  app.footer(
      "Examples:\n"
      "  What lcm-logger recorded, once through.\n"
      "    $ cremed-top --lcm-url file://heard.lcm");
  std::string url;
  bool is_once = false;
  cremed::add_lcm_url(app, url);
  app.add_flag("--once", is_once,
               "Listen for 1.5 s, print what was heard, whatever the status of the odometry, and "
               "exit: 0, or 1 if that was nothing or could not all be read");
  app.parse(argc, argv);
  cremed::require_audible(url);
  // LCM may test the network for seconds, in which signals do what they do elsewhere.
  Hearing hearing(url);
  cremed::handle_stop_signals();
  cremed::stop_at_hangup();
  return is_once ? print_once(hearing) : show(hearing);
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program(
      "cremed-top",
      "Shows cremed's state in a terminal\n"
      "Odometry with one sigma, and of each radar its scans, doubts and learned error, refreshed "
      "four times a second. It only listens. q ends it.",
      run, argc, argv);
}
