// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lcm_log_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{0xED, 0xA1, 0xDA, 0x01};
/// Magic, number and time of the message, lengths of channel and data; big-endian.
constexpr std::size_t kHeaderBytes = 28;
constexpr std::size_t kTimeOffset = 12;
constexpr std::size_t kChannelLengthOffset = 20;
constexpr std::size_t kDataLengthOffset = 24;
/// More than LCM's own limit of a channel, and than any message of a robot has.
constexpr std::size_t kLongestChannel = 999;
constexpr std::size_t kLongestData = std::size_t{1} << 28U;
/// A damaged length costs no more memory than this and the rest of the log.
constexpr std::size_t kPieceBytes = 1 << 20;

std::uint64_t number(const std::vector<std::uint8_t>& bytes, std::size_t offset, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = (value << 8U) | bytes[offset + i];
  }
  return value;
}

/// Of as many bytes as there are.
bool begins_a_message(const std::vector<std::uint8_t>& bytes) {
  const std::size_t size = std::min(bytes.size(), kMagic.size());
  return std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size),
                    kMagic.begin());
}

}  // namespace

LcmLogReader::LcmLogReader(const std::string& path) : input_(path, std::ios::binary), path_(path) {
  // A folder can be opened, but not read.
  if (!input_ || (input_.peek() == std::ifstream::traits_type::eof() && input_.bad())) {
    throw std::runtime_error(concat({"cannot read ", path, ": ", std::strerror(errno)}));
  }
  input_.clear();
}

const LoggedMessage* LcmLogReader::next() {
  bytes_.clear();
  read_some(kHeaderBytes);
  const std::string place = std::to_string(at_);
  if (bytes_.empty() || !damage_.empty()) {
    return nullptr;
  }
  if (!begins_a_message(bytes_)) {
    return end(at_ == 0 ? "is no LCM log; of a candump log `cremed --config FILE --replay LOG "
                          "--publish-scans --lcm-url 'file://OUT?mode=w'` makes one"
                        : concat({"damaged at byte ", place, ": no message begins there"}));
  }
  const std::size_t cut = kHeaderBytes - bytes_.size();
  const std::size_t channel = cut != 0 ? 0 : number(bytes_, kChannelLengthOffset, 4);
  const std::size_t data = cut != 0 ? 0 : number(bytes_, kDataLengthOffset, 4);
  if (channel > kLongestChannel || data > kLongestData) {
    return end(concat({"damaged at byte ", place, ": the message there has impossible lengths"}));
  }
  if (cut != 0 || read_some(channel + data) != channel + data) {
    return end(concat({"ends inside a message, which begins at byte ", place}));
  }
  const auto name = bytes_.begin() + static_cast<std::ptrdiff_t>(kHeaderBytes);
  const auto content = name + static_cast<std::ptrdiff_t>(channel);
  message_.recorded_us = static_cast<std::int64_t>(number(bytes_, kTimeOffset, 8));
  message_.channel.assign(name, content);
  message_.data.assign(content, bytes_.end());
  at_ += bytes_.size();
  return &message_;
}

const LoggedMessage* LcmLogReader::end(std::string_view damage) {
  damage_ = concat({path_, ": ", damage});
  return nullptr;
}

/// Appends to the message's bytes; returns how many there were.
std::size_t LcmLogReader::read_some(std::size_t size) {
  std::size_t done = 0;
  while (done < size && input_) {
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + std::min(size - done, kPieceBytes));
    input_.read(reinterpret_cast<char*>(bytes_.data() + begin),
                static_cast<std::streamsize>(bytes_.size() - begin));
    const auto count = static_cast<std::size_t>(input_.gcount());
    bytes_.resize(begin + count);
    done += count;
  }
  return done;
}

}  // namespace cremed
