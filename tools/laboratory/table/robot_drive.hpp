// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/table/drive_pairs.hpp"

namespace cremed {

/// A simulated mobile robot with a Bosch GPR on a campus, as the paper's recording is not public.
/// The destructor removes its files.
class RobotDrive {
 public:
  /// Throws std::runtime_error.
  explicit RobotDrive(std::uint64_t seed);

  [[nodiscard]] const DriveToPair& drive() const { return drive_; }

 private:
  TemporaryFolder folder_;
  DriveToPair drive_;
};

}  // namespace cremed
