// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replaced_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "daemon/message_text.hpp"

namespace cremed {
namespace {

constexpr mode_t kUsualPermissions = 0644;

/// Beside the file that it will replace; removed unless it did.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : path_(target + ".XXXXXX") {
    file_ = ::mkstemp(path_.data());
    check(file_ >= 0);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (file_ >= 0) {
      ::close(file_);
    }
    if (!path_.empty()) {
      ::unlink(path_.c_str());
    }
  }

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(file_, text.data(), text.size());
      check(written >= 0 || errno == EINTR);
      text.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
  }

  void replace(const std::string& target) {
    keep_permissions(target);
    check(::fsync(file_) == 0 && std::rename(path_.c_str(), target.c_str()) == 0);
    path_.clear();
  }

 private:
  void keep_permissions(const std::string& target) const {
    struct stat status {};
    if (::stat(target.c_str(), &status) != 0) {
      check(errno == ENOENT && ::fchmod(file_, kUsualPermissions) == 0);
      return;
    }
    check(::fchmod(file_, status.st_mode & 07777U) == 0);
    if (::fchown(file_, status.st_uid, status.st_gid) != 0) {
      errno = 0;  // Only root can; the file is then that of who edits it.
    }
  }

  void check(bool is_good) const {
    if (!is_good) {
      throw std::runtime_error(
          concat({"cannot write ", path_, ": ", std::generic_category().message(errno)}));
    }
  }

  std::string path_;
  int file_ = -1;
};

}  // namespace

void replace_file(const std::string& path, std::string_view text) {
  const std::string target = std::filesystem::weakly_canonical(path).string();
  TemporaryFile file(target);
  file.write(text);
  file.replace(target);
}

}  // namespace cremed
