// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/finding.hpp"

#include "daemon/process/message_text.hpp"

namespace cremed {

std::string to_text(const Finding& finding) { return concat({finding.what, "; ", finding.remedy}); }

}  // namespace cremed
