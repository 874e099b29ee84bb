# One shared library of all rooms, for programs of others: they need its headers, which need the standard library
# alone, and nothing else.
include(CMakePackageConfigHelpers)
add_library(delquad_library SHARED)
foreach(room IN LISTS DELQUAD_ROOMS)
  string(REPLACE "/" "_" name ${room})
  target_sources(delquad_library PRIVATE $<TARGET_OBJECTS:delquad_${name}>)
  target_link_libraries(delquad_library PRIVATE delquad_${name})  # for what these link
endforeach()
target_link_libraries(delquad_library PRIVATE delquad_flags)
target_include_directories(delquad_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(delquad_library INTERFACE cxx_std_20)
set_target_properties(delquad_library PROPERTIES OUTPUT_NAME delquad EXPORT_NAME delquad LINKER_LANGUAGE CXX
                      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION})

install(TARGETS delquad)
install(TARGETS delquad_library EXPORT delquad_targets)
install(DIRECTORY include/delquad DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT delquad_targets NAMESPACE delquad:: FILE delquad-config.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/delquad-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/delquad-config-version.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
