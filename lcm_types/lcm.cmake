# SPDX-FileCopyrightText: 2026 the cremed authors
# SPDX-License-Identifier: BSD-3-Clause
# cremed::lcm, LCM's library, where it is installed; here and in find_package(cremed).
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
if(LCM_INCLUDE_DIR AND LCM_LIBRARY AND NOT TARGET cremed::lcm)
  add_library(cremed::lcm SHARED IMPORTED GLOBAL)
  set_target_properties(cremed::lcm PROPERTIES
    IMPORTED_LOCATION ${LCM_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()
