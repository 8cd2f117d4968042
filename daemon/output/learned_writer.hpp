// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace cremed {

/// Writes a small file repeatedly in its own thread, because a disk may block for a second. The
/// file is replaced atomically (replace_file).
class LearnedWriter {
 public:
  explicit LearnedWriter(std::string path);
  /// Writes the last text offered.
  ~LearnedWriter();
  LearnedWriter(const LearnedWriter&) = delete;
  LearnedWriter& operator=(const LearnedWriter&) = delete;

  /// Sets the next text to write; replaces one that is still waiting. Does not block: false if the
  /// thread is just fetching one.
  bool offer(std::string text);
  /// The same for the end of the process; may block for a moment.
  void put(std::string text);
  /// Why the last text was not written; empty if it was. Nothing if the thread is just setting it.
  [[nodiscard]] std::optional<std::string> problem();

 private:
  void run();

  const std::string path_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::string> text_;
  std::string problem_;
  bool is_ending_ = false;
  std::thread thread_;  // Last member: the thread uses all others.
};

}  // namespace cremed
