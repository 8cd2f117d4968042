// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/file_aliases.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <system_error>
#include <tuple>

#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/message_text.hpp"
#include "daemon/process/usage_error.hpp"

namespace cremed {
namespace {

namespace fs = std::filesystem;

/// The kernel's own limit.
constexpr int kMaxLinks = 40;

/// Device and inode of a file; for a new file those of its folder, and its name.
using Identity = std::tuple<dev_t, ino_t, std::string>;

struct KnownFile {
  NamedFile file;
  std::optional<Identity> identity;  // Nothing: equals no other file.
};

std::optional<Identity> identity(const std::string& path) {
  struct stat status {};
  if (path.empty() || path == "-") {
    return std::nullopt;
  }
  if (::stat(path.c_str(), &status) == 0) {
    return S_ISCHR(status.st_mode) ? std::nullopt
                                   : std::optional(Identity{status.st_dev, status.st_ino, ""});
  }
  const fs::path file = end_of_links(path);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return ::stat(folder.c_str(), &status) == 0
             ? std::optional(Identity{status.st_dev, status.st_ino, file.filename()})
             : std::nullopt;
}

/// The file of a redirected standard stream.
KnownFile stream(int descriptor, const char* name) {
  struct stat status {};
  const bool is_file = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  return {{name, ""},
          is_file ? std::optional(Identity{status.st_dev, status.st_ino, ""}) : std::nullopt};
}

std::vector<KnownFile> known(const std::vector<NamedFile>& files) {
  std::vector<KnownFile> result;
  std::transform(files.begin(), files.end(), std::back_inserter(result), [](const NamedFile& file) {
    return KnownFile{file, identity(file.path)};
  });
  return result;
}

bool is_same(const KnownFile& a, const KnownFile& b) {
  const bool is_same_text = !a.file.path.empty() && a.file.path == b.file.path;
  return (a.identity && a.identity == b.identity) || (is_same_text && a.file.path == "-");
}

void refuse_overwriting(const KnownFile& output, const KnownFile& input) {
  if (is_same(input, output) && output.file.path != "-") {
    throw UsageError(concat({output.file.name, " would overwrite ", input.file.name, ", ",
                             output.file.path.empty() ? input.file.path : output.file.path,
                             "; name another file"}));
  }
}

void refuse_writing_twice(const KnownFile& output, const KnownFile& other) {
  if (is_same(output, other)) {
    throw UsageError(concat({output.file.name, " and ", other.file.name, " are one file, ",
                             output.file.path, "; name two"}));
  }
}

/// One table can be both the truth and the wheels; the frames of a log would count twice.
void refuse_reading_twice(const KnownFile& input, const KnownFile& other) {
  if (input.file.name == other.file.name && is_same(input, other)) {
    throw UsageError(concat({input.file.path, " is given twice; name it once"}));
  }
}

}  // namespace

fs::path end_of_links(fs::path path) {
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
    // An absolute target replaces the whole path.
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return path;
}

void refuse_aliases(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
  const KnownFile standard_input = stream(STDIN_FILENO, "standard input");
  const KnownFile standard_output = stream(STDOUT_FILENO, "standard output");
  const KnownFile standard_error = stream(STDERR_FILENO, "standard error");
  const std::vector<KnownFile> read = known(inputs);
  const std::vector<KnownFile> written = known(outputs);
  for (auto input = read.begin(); input != read.end(); ++input) {
    std::for_each(input + 1, read.end(),
                  [&](const KnownFile& other) { refuse_reading_twice(*input, other); });
    refuse_overwriting(standard_output, *input);
    refuse_overwriting(standard_error, *input);
    for (const KnownFile& output : written) {
      refuse_overwriting(output, *input);
    }
  }
  for (auto output = written.begin(); output != written.end(); ++output) {
    refuse_overwriting(*output, standard_input);
    refuse_writing_twice(*output, standard_error);
    std::for_each(output + 1, written.end(),
                  [&](const KnownFile& other) { refuse_writing_twice(*output, other); });
  }
}

std::string lcm_file(std::string_view url) {
  constexpr std::string_view kFileScheme = "file://";
  return url.starts_with(kFileScheme)
             ? std::string(url.substr(kFileScheme.size(), url.find('?') - kFileScheme.size()))
             : std::string();
}

}  // namespace cremed
