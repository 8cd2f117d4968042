# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
# Part of `cmake --install`: writes the unit from `unit_template` for the installed prefix.
cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_PREFIX NORMALIZE OUTPUT_VARIABLE prefix)
cmake_path(ABSOLUTE_PATH bindir BASE_DIRECTORY "${prefix}" OUTPUT_VARIABLE CMAKE_INSTALL_FULL_BINDIR)
cmake_path(ABSOLUTE_PATH docdir BASE_DIRECTORY "${prefix}" OUTPUT_VARIABLE CMAKE_INSTALL_FULL_DOCDIR)
string(REPLACE " " "\\x20" CMAKE_INSTALL_FULL_BINDIR "${CMAKE_INSTALL_FULL_BINDIR}")
string(REPLACE " " "%%20" CMAKE_INSTALL_FULL_DOCDIR "${CMAKE_INSTALL_FULL_DOCDIR}")
set(unit "${prefix}/lib/systemd/system/cremed.service")
message(STATUS "Installing: $ENV{DESTDIR}${unit}")
configure_file("${unit_template}" "$ENV{DESTDIR}${unit}" @ONLY)
list(APPEND CMAKE_INSTALL_MANIFEST_FILES "${unit}")
if(NOT prefix MATCHES "^/usr(/local)?/?$")
  message(STATUS "systemd does not look under ${prefix}; `systemctl link ${unit}` shows it the unit")
endif()
