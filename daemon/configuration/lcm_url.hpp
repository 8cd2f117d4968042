// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace cremed {

/// "none", or a URL with which LCM never blocks: udpm:// with a multicast group and a
/// valid ttl, file://PATH?mode=w or
/// memq://. tcpq:// would block the odometry while it waits for its server, a file without mode=w
/// is read.
bool is_lcm_url(std::string_view text);
inline constexpr const char* kLcmUrlWanted =
    "\"none\" or a URL such as \"udpm://239.255.76.67:7667?ttl=0\", with a group of "
    "224.0.0.0 to 239.255.255.255, a port of 1 to 65535 and a ttl of 0 to 255, or "
    "\"file://PATH?mode=w\"";

}  // namespace cremed
