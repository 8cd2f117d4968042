// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace cremed {

/// The word nearest to a misspelt one (edit distance, the first of equals); empty if none is near.
std::string_view nearest_word(std::string_view misspelt, std::span<const std::string_view> words);

}  // namespace cremed
