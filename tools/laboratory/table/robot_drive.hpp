// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/table/drive_pairs.hpp"

namespace cremed {

/// Simulates a mobile robot with a Bosch GPR on a campus, as the paper's recording is not public.
/// Writes the drive's files into the folder. Throws std::runtime_error.
DriveToPair robot_drive(std::uint64_t seed, const TemporaryFolder& folder);

}  // namespace cremed
