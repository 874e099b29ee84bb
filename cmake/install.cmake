# The libraries, their headers and what find_package(delquad) needs, for strategies of one's own.
include(CMakePackageConfigHelpers)
install(TARGETS delquad delquad_flags EXPORT delquad_targets)
install(EXPORT delquad_targets NAMESPACE delquad:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
foreach(folder mesh geometry cad fields smoothing algorithms surfaces metrics io pipeline sweep report apps)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/delquad FILES_MATCHING PATTERN "*.h")
endforeach()
configure_package_config_file(cmake/delquad-config.cmake.in ${CMAKE_BINARY_DIR}/delquad-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/delquad-config-version.cmake COMPATIBILITY ExactVersion)
install(FILES ${CMAKE_BINARY_DIR}/delquad-config.cmake ${CMAKE_BINARY_DIR}/delquad-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
