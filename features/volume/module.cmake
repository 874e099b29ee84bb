# SPDX-License-Identifier: GPL-3.0-or-later
find_path(DELQUAD_TETGEN_INCLUDE tetgen.h REQUIRED)
find_library(DELQUAD_TETGEN_LIBRARY tet REQUIRED)
mark_as_advanced(DELQUAD_TETGEN_INCLUDE DELQUAD_TETGEN_LIBRARY)
target_include_directories(delquad_features_volume SYSTEM PRIVATE ${DELQUAD_TETGEN_INCLUDE})
target_link_libraries(${DELQUAD_INTO} PRIVATE ${DELQUAD_TETGEN_LIBRARY})
