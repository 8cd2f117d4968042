// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace cremed {

/// Draws a picture with one of the installed scripts (Python, matplotlib): `script` is its name,
/// `inputs` the files it reads, and the picture is its last argument. Throws std::runtime_error.
void draw_plot(const std::string& script, const std::vector<std::string>& inputs,
               const std::string& picture);

/// Why this cannot be a picture's file; empty if it can. For CLI::Option::check.
std::string picture_problem(const std::string& path);

}  // namespace cremed
