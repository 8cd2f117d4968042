# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
"""cremed's messages, and a listener for them that needs nothing but Python:

    import cremed
    for heard in cremed.Listener():      # or cremed.read_log("FILE of lcm-logger")
        print(heard.channel, heard.message.utime)

A motion and a status come twice, on the channel of all and on that of their source: use one of these.
"""
from .ego_motion_t import ego_motion_t
from .fields import fields_of, names_of
from .listener import DamagedLog, Heard, Listener, OtherVersions, decoded, events_in, read_events, read_log
from .odometry_t import odometry_t
from .radar_scan_t import radar_scan_t
from .status_t import status_t

__all__ = ["DamagedLog", "Heard", "Listener", "decoded", "ego_motion_t", "events_in", "fields_of", "names_of",
           "odometry_t", "radar_scan_t", "read_events", "read_log", "status_t"]
