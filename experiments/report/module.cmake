# SPDX-License-Identifier: GPL-3.0-or-later
# The page around the results, its script and three.js, as text inside the program.
set(report ${PROJECT_SOURCE_DIR}/experiments/report)
file(GLOB page_parts CONFIGURE_DEPENDS ${report}/page/*.js ${report}/page/*.css ${report}/page/*.html ${report}/three/three.min.js)
add_custom_command(
  OUTPUT ${PROJECT_BINARY_DIR}/page_text.cpp
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${report} -DOUTPUT=${PROJECT_BINARY_DIR}/page_text.cpp -P ${report}/embed.cmake
  DEPENDS ${page_parts} ${report}/embed.cmake)
target_sources(delquad_experiments_report PRIVATE ${PROJECT_BINARY_DIR}/page_text.cpp)
