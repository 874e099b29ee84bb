# SPDX-License-Identifier: GPL-3.0-or-later
# The last configuration reads the commit; a new commit configures again.
set(DELQUAD_COMMIT "unknown")
find_package(Git QUIET)
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse HEAD
                  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(DELQUAD_COMMIT "${commit}")
  endif()
  if(EXISTS ${PROJECT_SOURCE_DIR}/.git/logs/HEAD)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/.git/logs/HEAD)
  endif()
endif()
find_file(lemon_config lemon/config.h REQUIRED NO_CACHE)
file(STRINGS ${lemon_config} lemon_version REGEX "LEMON_VERSION")
string(REGEX REPLACE ".*\"(.*)\".*" "\\1" DELQUAD_LEMON_VERSION "${lemon_version}")
configure_file(experiments/sweep/build_info.h.in ${PROJECT_BINARY_DIR}/generated/build_info.h @ONLY)
target_include_directories(delquad_experiments_sweep PRIVATE ${PROJECT_BINARY_DIR}/generated)
# A new commit compiles this file alone.
set_source_files_properties(experiments/sweep/machine.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
