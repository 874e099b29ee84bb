# SPDX-License-Identifier: GPL-3.0-or-later
# LEMON's headers are C++17: its solver is compiled by itself.
set_source_files_properties(base/matching/lemon_solver.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
  COMPILE_OPTIONS "-std=c++17;$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>")
