# SPDX-License-Identifier: GPL-3.0-or-later
# CGAL's graphs in the L-infinity norm take a minute to compile with optimization. One study, of a few seconds, uses them.
set_source_files_properties(algorithms/insertion/linf_delaunay.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON
  COMPILE_OPTIONS $<$<CONFIG:Release>:-O0>)
