// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/line_stream.hpp"

#include <stdexcept>
#include <string_view>

namespace cremed {
namespace {

constexpr std::size_t kManyBytes = 65536;

}  // namespace

void LineStream::finish() { buffer_.finish(); }

void LineStream::Buffer::finish() {
  file_.write(text_);
  text_.clear();
  if (file_.failures() != 0) {
    throw std::runtime_error(file_.problem());
  }
}

LineStream::Buffer::int_type LineStream::Buffer::overflow(int_type character) {
  const char text = traits_type::to_char_type(character);
  return xsputn(&text, 1) == 1 ? character : traits_type::eof();
}

std::streamsize LineStream::Buffer::xsputn(const char* text, std::streamsize size) {
  text_.append(text, static_cast<std::size_t>(size));
  return text_.size() < kManyBytes || write_lines() ? size : 0;
}

/// All complete lines.
bool LineStream::Buffer::write_lines() {
  const std::size_t whole = text_.rfind('\n') + 1;  // npos + 1 is 0.
  file_.write(std::string_view(text_).substr(0, whole));
  text_.erase(0, whole);
  return file_.failures() == 0;
}

}  // namespace cremed
