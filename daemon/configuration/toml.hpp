// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The only place that includes toml++, because its limits must be the same everywhere. Values in
// values in values: no key of ours goes deeper than a list in a table in a list of tables.
#define TOML_MAX_NESTED_VALUES 16
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/impl/preprocessor.h>

// toml++ 3.3 asserts (and has Clang assume, where NDEBUG is set) that a key begins as keys may
// begin, before it looks: "[=]" ends the program. The branch behind the assertion answers it.
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT_ASSUME(expr) static_assert(true)
#include <toml++/toml.h>
