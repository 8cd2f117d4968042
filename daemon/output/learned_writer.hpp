// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace cremed {

/// Writes a small file repeatedly in its own thread, because a disk may block for a second. The
/// file is replaced atomically (replace_regular_file).
class LearnedWriter {
 public:
  explicit LearnedWriter(std::string path);
  /// As finish(), if that was not called.
  ~LearnedWriter();
  LearnedWriter(const LearnedWriter&) = delete;
  LearnedWriter& operator=(const LearnedWriter&) = delete;

  /// Sets the next text to write; replaces one that is still waiting. Does not block: false if the
  /// thread is just fetching one.
  bool offer(std::string text);
  /// Why the last text was not written; empty if it was. Nothing if the thread is just setting it.
  [[nodiscard]] std::optional<std::string> problem() const;

  /// Writes the text, if any, and else the last one offered. Waits for the disk for half a
  /// second, then leaves it to the thread. Returns why the last text is not written; empty if it
  /// is.
  std::string finish(std::optional<std::string> text = std::nullopt);

 private:
  struct Shared;
  static void run(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;  // Outlives a writer that gave up waiting.
  std::thread thread_;
};

}  // namespace cremed
