# SPDX-License-Identifier: GPL-3.0-or-later
# Where helper programs are looked for.
file(RELATIVE_PATH libexec_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBEXECDIR})
file(RELATIVE_PATH libexec_from_lib ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_LIBEXECDIR})
set_source_files_properties(base/find_program.cpp PROPERTIES COMPILE_DEFINITIONS
  "DELQUAD_LIBEXEC=\"${CMAKE_INSTALL_FULL_LIBEXECDIR}\";DELQUAD_LIBEXEC_FROM_BIN=\"${libexec_from_bin}\";DELQUAD_LIBEXEC_FROM_LIB=\"${libexec_from_lib}\"")
