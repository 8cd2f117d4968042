// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace cremed {

/// Writes a small file again and again in a thread of its own: a disk may take a second to answer,
/// for which no scan can wait. The file is replaced at once (replace_file).
class LearnedWriter {
 public:
  explicit LearnedWriter(std::string path);
  /// Writes what was offered last.
  ~LearnedWriter();
  LearnedWriter(const LearnedWriter&) = delete;
  LearnedWriter& operator=(const LearnedWriter&) = delete;

  /// Takes a text that is to be written next, in place of one that was not begun yet. Does not
  /// wait: false if the thread is just taking one.
  bool offer(std::string text);
  /// The same at the end, when waiting for a moment does no harm.
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
  std::thread thread_;  // Last: it uses all the others.
};

}  // namespace cremed
