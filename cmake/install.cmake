# SPDX-License-Identifier: GPL-3.0-or-later
# Two shared libraries: "delquad" is the library, "delquad_bench" stands on it as a program of others would. Programs of others need
# their headers, which need the standard library alone. Libraries that are loaded when needed lie beside them.
include(CMakePackageConfigHelpers)
target_include_directories(delquad_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(delquad_library INTERFACE cxx_std_20)
set_target_properties(delquad_library PROPERTIES EXPORT_NAME delquad)
set_target_properties(delquad_bench PROPERTIES EXPORT_NAME bench)
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(delquad PROPERTIES INSTALL_RPATH $ORIGIN/${lib_from_bin})

# The script that draws figures, which a researcher may change.
configure_file(experiments/figures.py ${CMAKE_BINARY_DIR}/delquad-figures COPYONLY)
install(PROGRAMS experiments/figures.py DESTINATION ${CMAKE_INSTALL_LIBEXECDIR} RENAME delquad-figures)

get_property(loaded GLOBAL PROPERTY DELQUAD_LOADED)
install(TARGETS delquad)
install(TARGETS ${loaded} RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS delquad_library EXPORT delquad_targets LIBRARY NAMELINK_COMPONENT library)
install(TARGETS delquad_bench EXPORT delquad_bench_targets LIBRARY NAMELINK_COMPONENT library)
set_target_properties(delquad_library delquad_bench ${loaded} PROPERTIES INSTALL_RPATH $ORIGIN)
install(DIRECTORY include/delquad DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
install(EXPORT delquad_targets NAMESPACE delquad:: FILE delquad-targets.cmake DESTINATION ${folder} COMPONENT library)
install(EXPORT delquad_bench_targets NAMESPACE delquad:: FILE delquad-bench.cmake DESTINATION ${folder} COMPONENT library)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/delquad-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/delquad-config.cmake ${CMAKE_BINARY_DIR}/delquad-config-version.cmake DESTINATION ${folder} COMPONENT library)
