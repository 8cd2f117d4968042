// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/candump.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxSecondsDigits = 12;  // The largest value in microseconds fits an int64.
constexpr std::size_t kClassicCapacity = 8;
constexpr std::uint32_t kMaxStandardId = 0x7FF;
constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kDropPrefix = "DROPCOUNT: dropped ";

/// Static text that states the correct form; empty: no error.
using Error = std::string_view;
constexpr Error kStampShape =
    "time stamp must be (seconds.fraction) in digits, as of `candump -l` or `-ta`";
constexpr Error kSecondsLength = "seconds must have at most 12 digits";
constexpr Error kDecimals = "time stamp must have 6 or 9 decimals";
constexpr Error kInterfaceLength = "interface name must have 1 to 15 characters";
constexpr Error kFrameShape = "interface must be followed by a frame as id#data";
constexpr Error kIdDigits = "identifier must be 3 hex digits (standard) or 8 (extended)";
constexpr Error kStandardRange = "standard identifier must be at most 7FF";
constexpr Error kExtendedRange = "8-digit identifier must be at most 1FFFFFFF, 3FFFFFFF for errors";
constexpr Error kXlFrame = "CAN XL frames are not read: must be a classic or an FD frame";
constexpr Error kDataDigits = "data must be pairs of hex digits";
constexpr Error kClassicLength = "classic data must be at most 8 bytes";
constexpr Error kFdShape = "FD frame must be id##, one hex digit of flags, then data";
constexpr Error kFdLength = "FD data must be 0 to 8, 12, 16, 20, 24, 32, 48 or 64 bytes";
constexpr Error kRemoteShape = "remote request must be id#R, or id#R and a length of 0 to 8";
constexpr Error kRawDlc = "raw length code must be _9 to _F after a length of 8";
constexpr Error kErrorKind = "error frame must be classic data";
constexpr Error kTail = "only R or T may follow the frame";
constexpr Error kConsoleShape =
    "console line must have as many bytes after the [length] as it says, in hex";
constexpr Error kNoStamp =
    "console output without time: must be recorded by `candump -l`, or at least `candump -ta`";
constexpr Error kNoFrame = "a frame's line must begin with (seconds.fraction)";

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_no_blank(char c) { return !is_blank(c); }
constexpr bool is_no_quote(char c) { return c != '\''; }

/// Consumes a line from left to right.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  bool take(char wanted) {
    if (!rest_.starts_with(wanted)) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }
  // A string_view's own search calls the library for every character.
  template <typename Condition>
  std::string_view take_while(Condition condition) {
    const auto* const end = std::find_if_not(rest_.begin(), rest_.end(), condition);
    return take_size(static_cast<std::size_t>(end - rest_.begin()));
  }
  std::string_view take_digits() { return take_while(is_digit); }
  std::string_view take_word() { return take_while(is_no_blank); }
  std::string_view take_rest() { return take_size(rest_.size()); }
  bool take_blanks() { return !take_while(is_blank).empty(); }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view take_size(std::size_t size) {
    const std::string_view piece = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return piece;
  }

  std::string_view rest_;
};

/// -1: not a hex digit.
constexpr int hex_nibble(char c) {
  return is_digit(c)            ? c - '0'
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                : -1;
}

constexpr bool is_fd_length(std::size_t length) {
  return length <= 8 || length == 12 || length == 16 || length == 20 || length == 24 ||
         length == 32 || length == 48 || length == 64;
}

Error parse_stamp(Cursor& cursor, CandumpLine& line) {
  cursor.take('(');
  const std::string_view seconds = cursor.take_digits();
  const bool has_point = cursor.take('.');
  const std::string_view decimals = cursor.take_digits();
  if (seconds.empty() || !has_point || !cursor.take(')') || !cursor.take_blanks()) {
    return kStampShape;
  }
  if (seconds.size() > kMaxSecondsDigits) {
    return kSecondsLength;
  }
  if (decimals.size() != 6 && decimals.size() != 9) {
    return kDecimals;
  }
  const auto micros = whole_number<std::int64_t>(decimals.substr(0, 6));  // 9: rounded down.
  line.frame.stamp_us = *whole_number<std::int64_t>(seconds) * 1'000'000 + *micros;
  return {};
}

Error parse_interface(Cursor& cursor, CandumpLine& line) {
  line.interface_name = cursor.take_word();
  if (line.interface_name.empty() || line.interface_name.size() > kMaxInterfaceName) {
    return kInterfaceLength;
  }
  return cursor.take_blanks() ? Error{} : kFrameShape;
}

/// Error frames are written as extended frames with a flag beyond the identifier's bits.
Error parse_identifier(std::string_view digits, CanFrame& frame) {
  constexpr int kHexadecimal = 16;
  const auto id = whole_number<std::uint32_t>(digits, kHexadecimal);
  const bool is_standard = digits.size() == 3;
  if ((!is_standard && digits.size() != 8) || !id) {
    return kIdDigits;
  }
  frame.id = *id & kMaxExtendedId;
  frame.error = (*id & ~kMaxExtendedId) == kCandumpErrorFlag;
  frame.extended = !is_standard && !frame.error;
  if (is_standard) {
    return *id <= kMaxStandardId ? Error{} : kStandardRange;
  }
  return frame.error || *id <= kMaxExtendedId ? Error{} : kExtendedRange;
}

/// Pairs of hex digits, optionally separated by '.'.
Error parse_bytes(std::string_view text, std::size_t capacity, CanFrame& frame) {
  for (std::size_t at = 0; at < text.size(); at += 2) {
    at += text[at] == '.' ? 1 : 0;
    const int high = at < text.size() ? hex_nibble(text[at]) : -1;
    const int low = at + 1 < text.size() ? hex_nibble(text[at + 1]) : -1;
    if ((high | low) < 0) {
      return kDataDigits;
    }
    if (frame.length == capacity) {
      return capacity == kClassicCapacity ? kClassicLength : kFdLength;
    }
    frame.data[frame.length++] = static_cast<std::uint8_t>(16 * high + low);
  }
  return {};
}

Error parse_fd(std::string_view text, CanFrame& frame) {
  frame.fd = true;
  if (text.empty() || hex_nibble(text.front()) < 0) {
    return kFdShape;
  }
  const Error error = parse_bytes(text.substr(1), frame.data.size(), frame);
  return error.empty() && !is_fd_length(frame.length) ? kFdLength : error;
}

Error parse_remote(std::string_view text, CanFrame& frame) {
  frame.remote = true;
  if (text.empty()) {
    return {};
  }
  const int length = hex_nibble(text.front());
  if (text.size() > 1 || length < 0 || length > static_cast<int>(kClassicCapacity)) {
    return kRemoteShape;
  }
  frame.length = static_cast<std::uint8_t>(length);
  return {};
}

/// The raw length code of a frame with 8 bytes (candump -8): checked and ignored.
Error parse_raw_dlc(std::string_view text, const CanFrame& frame) {
  const bool is_code = text.size() == 1 && hex_nibble(text.front()) >= 9;
  return is_code && frame.length == kClassicCapacity ? Error{} : kRawDlc;
}

Error parse_classic(std::string_view text, CanFrame& frame) {
  const std::size_t underscore = text.find('_');
  const std::string_view body = text.substr(0, underscore);
  const bool remote = body.starts_with('R') || body.starts_with('r');
  const Error error =
      remote ? parse_remote(body.substr(1), frame) : parse_bytes(body, kClassicCapacity, frame);
  if (!error.empty() || underscore == std::string_view::npos) {
    return error;
  }
  return parse_raw_dlc(text.substr(underscore + 1), frame);
}

Error parse_console_bytes(Cursor& cursor, std::uint64_t length, CanFrame& frame) {
  const std::size_t capacity = frame.fd ? frame.data.size() : kClassicCapacity;
  for (std::uint64_t i = 0; i < length; ++i) {
    const std::string_view byte = cursor.take_blanks() ? cursor.take_word() : "";
    if (byte.size() != 2 || !parse_bytes(byte, capacity, frame).empty()) {
      return kConsoleShape;
    }
  }
  return frame.fd && !is_fd_length(frame.length) ? kFdLength : Error{};
}

/// The terminal format of candump: `123   [8]  11 22 33 44 55 66 77 88`, for FD `[08]`, after `RX -
/// -` with -x. The rest (text by -a, ERRORFRAME) is ignored.
Error parse_console(Cursor& cursor, std::string_view word, CandumpLine& line) {
  if (word == "RX" || word == "TX") {
    for (int i = 0; i < 3; ++i) {
      cursor.take_blanks();
      word = cursor.take_word();
    }
  }
  const bool has_bracket = cursor.take_blanks() && cursor.take('[');
  const std::string_view length = cursor.take_digits();
  const auto bytes = whole_number<std::uint64_t>(length);
  if (!has_bracket || !cursor.take(']') || !bytes) {
    return kFrameShape;
  }
  if (const Error error = parse_identifier(word, line.frame); !error.empty()) {
    return error;
  }
  line.frame.fd = length.size() == 2;
  Cursor text = cursor;
  const bool is_remote = !line.frame.fd && text.take_blanks() && text.take_word() == "remote";
  const Error error = is_remote ? parse_remote(length, line.frame)
                                : parse_console_bytes(cursor, *bytes, line.frame);
  cursor.take_rest();
  return error;
}

Error check_kind(const CanFrame& frame) {
  return frame.error && (frame.fd || frame.remote) ? kErrorKind : Error{};
}

Error parse_content(Cursor& cursor, CandumpLine& line) {
  const std::string_view digits =
      cursor.take_while([](char c) { return c != '#' && is_no_blank(c); });
  if (!cursor.take('#')) {
    const Error error = parse_console(cursor, digits, line);
    return error.empty() ? check_kind(line.frame) : error;
  }
  const bool fd = cursor.take('#');
  const std::string_view content = cursor.take_word();
  if (content.size() > 2 && content[2] == ':') {  // XL: id#flags:type:field#data
    return kXlFrame;
  }
  if (const Error error = parse_identifier(digits, line.frame); !error.empty()) {
    return error;
  }
  const Error error = fd ? parse_fd(content, line.frame) : parse_classic(content, line.frame);
  return error.empty() ? check_kind(line.frame) : error;
}

/// candump -x marks frames as received or transmitted.
Error parse_tail(Cursor& cursor, CandumpLine& /*line*/) {
  if (cursor.take_blanks() && (cursor.take('R') || cursor.take('T'))) {
    cursor.take_blanks();
  }
  return cursor.at_end() ? Error{} : kTail;
}

CandumpLine parse_frame(std::string_view text) {
  Cursor cursor(text);
  CandumpLine line;
  for (const auto step : {parse_stamp, parse_interface, parse_content, parse_tail}) {
    if (const Error error = step(cursor, line); !error.empty()) {
      return {.status = CandumpStatus::malformed, .error = error};
    }
  }
  line.status = CandumpStatus::frame;
  return line;
}

/// `DROPCOUNT: dropped 4722 CAN frames on 'can0' socket (total drops 4722)`
CandumpLine parse_drop_count(std::string_view text) {
  Cursor cursor(text.substr(kDropPrefix.size()));
  CandumpLine line;
  const auto count = whole_number<std::uint64_t>(cursor.take_digits());
  cursor.take_while(is_no_quote);
  const bool opened = cursor.take('\'');
  line.interface_name = cursor.take_while(is_no_quote);
  if (count && opened && cursor.take('\'') && !line.interface_name.empty()) {
    line.status = CandumpStatus::dropped;
    line.dropped_frames = *count;
    return line;
  }
  return {};
}

/// Neither comment nor empty: to be reported to the user.
CandumpLine parse_other(std::string_view text) {
  if (text.empty() || text.starts_with('#') || text.starts_with("DROPCOUNT")) {
    return {};
  }
  Cursor cursor(text);
  CandumpLine console;
  const bool is_console =
      parse_interface(cursor, console).empty() && parse_content(cursor, console).empty();
  return {.status = CandumpStatus::malformed, .error = is_console ? kNoStamp : kNoFrame};
}

std::string_view without_line_end(std::string_view text) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

/// Terminal output begins with blanks.
std::string_view without_blanks_before(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

}  // namespace

CandumpLine parse_candump_line(std::string_view line) {
  const std::string_view text = without_blanks_before(without_line_end(line));
  if (text.starts_with('(')) {
    return parse_frame(text);
  }
  if (text.starts_with(kDropPrefix)) {
    return parse_drop_count(text);
  }
  // `candump -e` explains an error frame in lines that begin with a tab.
  return line.starts_with('\t') ? CandumpLine{} : parse_other(text);
}

}  // namespace cremed
