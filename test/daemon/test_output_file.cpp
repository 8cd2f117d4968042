// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <string>

#include <catch2/catch.hpp>
#include <sys/resource.h>

#include "daemon/process/output_file.hpp"
#include "test/daemon/temporary_file.hpp"

namespace cremed {
namespace {

/// A disk that is full after this many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_CASE("On a full disk the file ends on a whole line, and the lost line is named") {
  const TemporaryFile target;
  OutputFile file(target.path());
  {
    const FileSizeLimit limit(10);
    file.write("first\n");   // 6 bytes
    file.write("second\n");  // cut after 4
  }
  file.write("third\n");  // There is room again, but the file must not have a gap.
  CHECK(target.content() == "first\n");
  CHECK(file.failures() == 2);
  CHECK(file.problem() == target.path() +
                              ": line 2 could not be written: File too large; the file ends with "
                              "the line before");
}

TEST_CASE("Of many lines written at once those that fit stay") {
  const TemporaryFile target;
  OutputFile file(target.path());
  {
    const FileSizeLimit limit(10);
    file.write("one\ntwo\nthree\nfour\n");
  }
  CHECK(target.content() == "one\ntwo\n");
  CHECK(file.problem().find("line 3 could") != std::string::npos);
}

TEST_CASE("A file that took all has no problem; a device is no file to cut") {
  const TemporaryFile target("old content, longer than the new");
  OutputFile file(target.path());
  file.write("new\n");
  CHECK(file.problem().empty());
  CHECK(target.content() == "new\n");
  OutputFile full("/dev/full");
  full.write("a\n");
  CHECK(full.problem() == "/dev/full: line 1 could not be written: No space left on device");
}

}  // namespace
}  // namespace cremed
