// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace cremed {

/// Draws a picture by one of the scripts (Python, matplotlib) that are installed with cremed-eval:
/// `script` is its name, `inputs` the files it reads, and the picture comes last on its command
/// line. Throws std::runtime_error.
void draw_plot(const std::string& script, const std::vector<std::string>& inputs,
               const std::string& picture);

}  // namespace cremed
