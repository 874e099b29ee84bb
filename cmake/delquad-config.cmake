# SPDX-License-Identifier: GPL-3.0-or-later
# find_package(delquad): delquad::delquad. With COMPONENTS bench also delquad::bench.
include(${CMAKE_CURRENT_LIST_DIR}/delquad-targets.cmake)
foreach(component IN LISTS delquad_FIND_COMPONENTS)
  include(${CMAKE_CURRENT_LIST_DIR}/delquad-${component}.cmake OPTIONAL RESULT_VARIABLE delquad_${component}_FOUND)
  if(delquad_FIND_REQUIRED_${component} AND NOT delquad_${component}_FOUND)
    set(delquad_FOUND FALSE)
    set(delquad_NOT_FOUND_MESSAGE "delquad has no component '${component}': expected bench")
  endif()
endforeach()
