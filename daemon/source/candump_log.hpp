// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/source/candump_reader.hpp"
#include "daemon/source/frame_source.hpp"

namespace cremed {

/// One candump log (or standard input) as a source of frames.
class CandumpLog final : public FrameSource {
 public:
  /// `interfaces`: names in the order of CanFrame::interface. Reading ends when `*stop` is set.
  /// Throws std::runtime_error if the log cannot be opened or has another format.
  CandumpLog(const std::string& path, std::vector<std::string> interfaces,
             const volatile std::sig_atomic_t* stop);

  /// Throws std::runtime_error at the first line of a pipe with another format.
  SourceEvent next(CanFrame& frame) override;

  [[nodiscard]] const CandumpReader& reader() const { return reader_; }
  [[nodiscard]] std::size_t interface_count() const { return interfaces_.size(); }
  /// Whether the interface with that index had a frame.
  [[nodiscard]] bool has_frames(std::size_t interface) const { return has_frames_[interface]; }
  /// Interfaces in the log without a configured radar; the first few.
  [[nodiscard]] const std::vector<std::string>& other_interfaces() const {
    return other_interfaces_;
  }

 private:
  void count_other(std::string_view interface);
  /// Index of the interface, or interfaces_.size().
  [[nodiscard]] std::size_t index_of(std::string_view interface_name) const;

  CandumpReader reader_;
  std::vector<std::string> interfaces_;
  std::vector<bool> has_frames_;
  std::vector<std::string> other_interfaces_;
  std::size_t untold_losses_ = 0;  // Interfaces that `candump any` may have lost frames of.
  const volatile std::sig_atomic_t* stop_;
};

}  // namespace cremed
