// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/toml_document.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

#include "daemon/configuration/toml.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxDotsInLine = 128;

/// toml++ 3.3 limits the nesting of values but not of dotted keys, and destroys tables recursively:
/// about ten thousand dots in one key overflow the stack. A key cannot span lines, so the dots of a
/// line bound its depth. Consecutive dots (a drawn line) do not nest.
std::size_t first_line_with_too_many_dots(std::string_view text) {
  std::size_t line = 1;
  std::size_t dots = 0;
  char previous = '\n';
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '.' && previous != '.' && ++dots > kMaxDotsInLine) {
      return line;
    }
    previous = c == ' ' || c == '\t' ? previous : c;
  }
  return 0;
}

/// Tracks whether a character is in a comment: '#' outside strings to the end of the line.
/// Multi-line strings are not tracked.
class CommentTracker {
 public:
  /// Takes the next character; true if it belongs to a comment.
  bool advance(char c) {
    if (c == '\n') {
      *this = CommentTracker();
    } else if (in_comment_ || escaped_) {
      escaped_ = false;
    } else if (quote_ != '\0') {
      escaped_ = quote_ == '"' && c == '\\';
      quote_ = c == quote_ ? '\0' : quote_;
    } else {
      in_comment_ = c == '#';
      quote_ = c == '"' || c == '\'' ? c : '\0';
    }
    return in_comment_;
  }

 private:
  bool in_comment_ = false;
  bool escaped_ = false;
  char quote_ = '\0';
};

bool is_ascii(char c) { return (static_cast<unsigned char>(c) & 0x80U) == 0; }

/// toml++ 3.3 has undefined behaviour on characters above U+007F in invalid places (its issues 190
/// and 295). In comments they become '?'; elsewhere they are refused, so the result is ASCII even
/// if the tracker errs. Returns the offending line, 0 for none.
std::size_t make_ascii(std::string& text) {
  CommentTracker tracker;
  std::size_t line = 1;
  for (char& c : text) {
    const bool in_comment = tracker.advance(c);
    line += c == '\n' ? 1 : 0;
    if (!is_ascii(c)) {
      if (!in_comment) {
        return line;
      }
      c = '?';
    }
  }
  return 0;
}

/// Prepares the text for toml++; false if it is refused.
bool prepare(std::string& text, Diagnostics& diagnostics) {
  if (const std::size_t line = make_ascii(text); line > 0) {
    diagnostics.add(line, "syntax",
                    "a character is not ASCII; must be in a comment, or written in a \"string\" as "
                    "its number, like \\u00E9");
    return false;
  }
  if (const std::size_t line = first_line_with_too_many_dots(text); line > 0) {
    diagnostics.add(line, "syntax", "too many dots; a line must have at most 128");
    return false;
  }
  return true;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string read_toml(const std::string& path) {
  // Without O_NONBLOCK a FIFO would wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  const std::unique_ptr<std::FILE, CloseFile> file(descriptor < 0 ? nullptr
                                                                  : ::fdopen(descriptor, "rb"));
  struct stat status {};
  if (!file || ::fstat(descriptor, &status) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  if (!S_ISREG(status.st_mode)) {
    throw std::system_error(S_ISDIR(status.st_mode) ? EISDIR : ENOTSUP, std::generic_category());
  }
  std::string text(kMaxTomlBytes + 1, '\0');  // One byte over the limit shows a larger file.
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get()) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  return text;
}

std::shared_ptr<const toml::table> parse_toml(std::string_view text, Diagnostics& diagnostics) {
  if (text.size() > kMaxTomlBytes) {
    diagnostics.add(1, "file", "is too large; must be a TOML file of at most 256 KiB");
    return nullptr;
  }
  std::string ascii(without_byte_order_mark(text));
  if (!prepare(ascii, diagnostics)) {
    return nullptr;
  }
  try {
    return std::make_shared<const toml::table>(toml::parse(std::string_view(ascii)));
  } catch (const toml::parse_error& error) {
    diagnostics.add(error.source().begin.line, "syntax",
                    concat({error.description(), "; must be TOML 1.0 (strings in \"quotes\")"}));
    return nullptr;
  }
}

}  // namespace cremed
