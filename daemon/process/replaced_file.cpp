// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/replaced_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/descriptor.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/output_file.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
namespace {

constexpr mode_t kUsualPermissions = 0644;
constexpr const char* kDescriptors = "/proc/self/fd/";

/// The new content, beside the target; removed unless it was renamed. Where the file system can, it
/// has no name until it is on the disk: a process that ends meanwhile leaves nothing behind.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : target_(target) {
    // rename(2) does not check this permission.
    check(::access(target.c_str(), W_OK) == 0 || errno == ENOENT);
    const std::filesystem::path folder = std::filesystem::path(target).parent_path();
    if (::access(kDescriptors, X_OK) == 0) {
      file_ = Descriptor(::open(folder.empty() ? "." : folder.c_str(),
                                O_TMPFILE | O_WRONLY | O_CLOEXEC, S_IRUSR | S_IWUSR));
    }
    if (!file_.is_open()) {
      path_ = target + ".XXXXXX";
      file_ = Descriptor(::mkostemp(path_.data(), O_CLOEXEC));
    }
    check(file_.is_open());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) {
      ::unlink(path_.c_str());
    }
  }

  void write(std::string_view text) { check(write_all(file_.number(), text)); }

  void replace() {
    keep_permissions();
    check(::fsync(file_.number()) == 0);
    if (path_.empty()) {
      give_name();
    }
    check(std::rename(path_.c_str(), target_.c_str()) == 0);
    path_.clear();
  }

 private:
  void give_name() {
    const std::string content = kDescriptors + std::to_string(file_.number());
    const std::string name = concat({target_, ".", std::to_string(::gettid())});
    ::unlink(name.c_str());  // Of a process with this number that ended here, as at a power cut.
    check(::linkat(AT_FDCWD, content.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0);
    path_ = name;
  }

  void keep_permissions() const {
    struct stat status {};
    if (::stat(target_.c_str(), &status) != 0) {
      check(errno == ENOENT && ::fchmod(file_.number(), kUsualPermissions) == 0);
      return;
    }
    check(::fchmod(file_.number(), status.st_mode & 07777U) == 0);
    if (::fchown(file_.number(), status.st_uid, status.st_gid) != 0) {
      errno = 0;  // Only root may change the owner; otherwise the file belongs to the caller.
    }
  }

  void check(bool is_good) const {
    if (!is_good) {
      throw std::runtime_error(
          concat({"cannot write ", target_, ": ", std::generic_category().message(errno)}));
    }
  }

  std::string target_;
  std::string path_;
  Descriptor file_;
};

/// Devices, pipes and standard output, wherever that goes, cannot be replaced; they are written to.
bool is_no_file(const std::string& path) {
  struct stat status {};
  const bool is_standard_output =
      path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
  return is_standard_output || (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode));
}

void write_through(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  if (file.failures() != 0) {
    throw std::runtime_error(file.problem());
  }
}

}  // namespace

void require_replaceable(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw std::runtime_error(concat({"cannot write ", path, ": it is a folder"}));
  }
  if (!is_no_file(path)) {
    const SignalsBlocked blocked;
    const TemporaryFile file(std::filesystem::weakly_canonical(end_of_links(path)).string());
  }
}

void replace_file(const std::string& path, std::string_view text) {
  if (is_no_file(path)) {
    write_through(path, text);
  } else {
    replace_regular_file(path, text);
  }
}

void replace_regular_file(const std::string& path, std::string_view text) {
  if (is_no_file(path)) {
    throw std::runtime_error(concat({"cannot write ", path, ": it is a folder, pipe or device"}));
  }
  const SignalsBlocked blocked;  // A signal must not leave the temporary file behind.
  TemporaryFile file(std::filesystem::weakly_canonical(end_of_links(path)).string());
  file.write(text);
  file.replace();
}

}  // namespace cremed
