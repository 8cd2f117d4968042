# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
# Part of `cmake --install`: writes the unit from `unit_template`, for the prefix that is installed to.
cmake_path(ABSOLUTE_PATH bindir BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE)
cmake_path(ABSOLUTE_PATH docdir BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE)
set(CREMED_PROGRAM ${bindir}/cremed)
set(CREMED_README ${docdir}/README.md)
set(unit ${CMAKE_INSTALL_PREFIX}/lib/systemd/system/cremed.service)
message(STATUS "Installing: $ENV{DESTDIR}${unit}")
configure_file(${unit_template} $ENV{DESTDIR}${unit} @ONLY)
list(APPEND CMAKE_INSTALL_MANIFEST_FILES ${unit})
if(NOT CMAKE_INSTALL_PREFIX MATCHES "^/usr(/local)?/?$")
  message(STATUS "systemd does not look under ${CMAKE_INSTALL_PREFIX}; "
    "`systemctl link ${unit}` shows it the unit")
endif()
