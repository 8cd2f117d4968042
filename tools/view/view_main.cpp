// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <stop_token>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "daemon/process/signals.hpp"
#include "tools/program.hpp"
#include "tools/view/heard_state.hpp"
#include "tools/view/lcm_listener.hpp"
#include "tools/view/listening.hpp"
#include "tools/view/view_server.hpp"

namespace {

constexpr int kRunTimeFailure = 1;
constexpr int kHighestPort = 65535;
constexpr std::chrono::milliseconds kPause{100};

struct Arguments {
  std::string lcm_url;
  cremed::ViewAddress address;
};

/// Listens until it is to stop, then ends the server. At the end of a log (file://) the page stays.
void listen(const std::stop_token& stop, cremed::LcmListener& listener,
            cremed::ViewServer& server) {
  bool hears = true;
  bool has_warned = false;
  while (!stop.stop_requested() && !cremed::stop_requested()) {
    if (hears) {
      hears = listener.listen();
      if (const std::string damage = listener.damage(); !damage.empty()) {
        std::fprintf(stderr, "%s; what comes before is shown\n", damage.c_str());
      }
      if (const std::string others = listener.other_versions(); !others.empty() && !has_warned) {
        std::fprintf(stderr, "%s\n", others.c_str());
        has_warned = true;
      }
    } else {
      std::this_thread::sleep_for(kPause);
    }
  }
  server.stop();
}

int show(const Arguments& arguments) {
  cremed::HeardState state;
  // LCM may test the network for seconds, in which signals do what they do elsewhere.
  cremed::LcmListener listener(arguments.lcm_url, state);
  cremed::handle_stop_signals();
  cremed::ViewServer server(state, arguments.address);
  const std::string& host = arguments.address.host;
  const bool is_ipv6 = host.find(':') != std::string::npos;
  std::printf("http://%s%s%s:%d/ shows what is heard at %s\n", is_ipv6 ? "[" : "", host.c_str(),
              is_ipv6 ? "]" : "", server.port(), arguments.lcm_url.c_str());
  std::fflush(stdout);
  const std::jthread listening(
      [&](const std::stop_token& stop) { listen(stop, listener, server); });
  server.run();
  return cremed::stop_requested() ? 0 : kRunTimeFailure;
}

int run(CLI::App& app, int argc, char** argv) {
  app.footer(
      "Examples:\n"
      "  Of a vehicle without a screen, for a browser on another computer.\n"
      "    $ cremed-view --address 0.0.0.0\n"
      "  What lcm-logger recorded.\n"
      "    $ cremed-view --lcm-url file://heard.lcm");
  Arguments arguments;
  cremed::add_lcm_url(app, arguments.lcm_url);
  app.add_option("--address", arguments.address.host,
                 "Address to serve on; 0.0.0.0: whoever reaches this computer may look")
      ->type_name("ADDRESS")
      ->capture_default_str();
  app.add_option("--port", arguments.address.port, "Port to serve on; 0: any that is free")
      ->check(CLI::Range(0, kHighestPort))
      ->capture_default_str();
  app.parse(argc, argv);
  cremed::require_audible(arguments.lcm_url);
  return show(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program(
      "cremed-view",
      "Shows the messages of cremed in a browser\n"
      "Path, motion, targets and radars, on a page that needs no other network. It only listens: "
      "nothing can be changed through it.",
      run, argc, argv);
}
