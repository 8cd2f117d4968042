// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/learned_writer.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "daemon/process/message_text.hpp"
#include "daemon/process/real_time.hpp"
#include "daemon/process/replaced_file.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
namespace {

/// A reload and the end of the process must take less than two seconds (WatchdogSec,
/// TimeoutStopSec).
constexpr std::chrono::milliseconds kLongestWait{500};

std::string problem_of_writing(const std::string& path, const std::string& text) {
  try {
    replace_regular_file(path, text);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace

struct LearnedWriter::Shared {
  explicit Shared(std::string file) : path(std::move(file)) {}

  const std::string path;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<std::string> text;
  std::string problem;
  bool is_ending = false;
  bool has_ended = false;
};

LearnedWriter::LearnedWriter(std::string path)
    : shared_(std::make_shared<Shared>(std::move(path))) {
  const SignalsBlocked blocked;  // Signals must reach the main loop, to interrupt its reads.
  thread_ = std::thread(&LearnedWriter::run, shared_);
}

LearnedWriter::~LearnedWriter() { finish(); }

bool LearnedWriter::offer(std::string text) {
  {
    const std::unique_lock lock(shared_->mutex, std::try_to_lock);
    if (!lock) {
      return false;
    }
    shared_->text = std::move(text);
  }
  shared_->changed.notify_all();
  return true;
}

std::optional<std::string> LearnedWriter::problem() const {
  const std::unique_lock lock(shared_->mutex, std::try_to_lock);
  return lock ? std::optional(shared_->problem) : std::nullopt;
}

std::string LearnedWriter::finish(std::optional<std::string> text) {
  if (!thread_.joinable()) {
    return {};
  }
  std::unique_lock lock(shared_->mutex);
  if (text) {
    shared_->text = std::move(text);
  }
  shared_->is_ending = true;
  shared_->changed.notify_all();
  const bool has_ended =
      shared_->changed.wait_for(lock, kLongestWait, [&] { return shared_->has_ended; });
  std::string problem =
      has_ended ? shared_->problem : concat({"the disk of ", shared_->path, " does not answer"});
  lock.unlock();
  has_ended ? thread_.join() : thread_.detach();
  return problem;
}

void LearnedWriter::run(const std::shared_ptr<Shared>& shared) {
  leave_real_time();
  std::unique_lock lock(shared->mutex);
  while (true) {
    shared->changed.wait(lock, [&] { return shared->is_ending || shared->text; });
    if (!shared->text) {
      break;
    }
    const std::string text = *std::exchange(shared->text, std::nullopt);
    lock.unlock();
    std::string problem = problem_of_writing(shared->path, text);
    lock.lock();
    shared->problem = std::move(problem);
  }
  shared->has_ended = true;
  shared->changed.notify_all();
}

}  // namespace cremed
