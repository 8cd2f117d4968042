// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/learned_writer.hpp"

#include <stdexcept>
#include <utility>

#include "daemon/process/real_time.hpp"
#include "daemon/process/replaced_file.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
LearnedWriter::LearnedWriter(std::string path) : path_(std::move(path)) {
  const SignalsBlocked blocked;  // Signals must reach the main loop, to interrupt its reads.
  thread_ = std::thread(&LearnedWriter::run, this);
}

LearnedWriter::~LearnedWriter() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool LearnedWriter::offer(std::string text) {
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) {
      return false;
    }
    text_ = std::move(text);
  }
  changed_.notify_one();
  return true;
}

void LearnedWriter::put(std::string text) {
  {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
  }
  changed_.notify_one();
}

std::optional<std::string> LearnedWriter::problem() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::optional(problem_) : std::nullopt;
}

void LearnedWriter::run() {
  leave_real_time();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || text_; });
    if (!text_) {
      return;
    }
    const std::string text = *std::exchange(text_, std::nullopt);
    lock.unlock();
    std::string problem;
    try {
      replace_file(path_, text);
    } catch (const std::runtime_error& error) {
      problem = error.what();
    }
    lock.lock();
    problem_ = std::move(problem);
  }
}

}  // namespace cremed
