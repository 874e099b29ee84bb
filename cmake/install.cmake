# Two shared libraries for programs of others: they need their headers, which need the standard library alone, and
# nothing else. "delquad" is the library; "delquad_bench" stands on it, as a program of others would.
include(CMakePackageConfigHelpers)
add_library(delquad_library SHARED)
foreach(room IN LISTS DELQUAD_LIBRARY_ROOMS)
  string(REPLACE "/" "_" name ${room})
  target_sources(delquad_library PRIVATE $<TARGET_OBJECTS:delquad_${name}>)
  target_link_libraries(delquad_library PRIVATE delquad_${name})  # for what these link
endforeach()
target_include_directories(delquad_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(delquad_library INTERFACE cxx_std_20)
set_target_properties(delquad_library PROPERTIES OUTPUT_NAME delquad EXPORT_NAME delquad)

target_link_libraries(delquad_bench PUBLIC delquad_library)
set_target_properties(delquad_bench PROPERTIES EXPORT_NAME bench INSTALL_RPATH $ORIGIN)
foreach(library delquad_library delquad_bench)
  target_link_libraries(${library} PRIVATE delquad_flags)
  set_target_properties(${library} PROPERTIES LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION})
endforeach()

install(TARGETS delquad)
install(TARGETS delquad_library EXPORT delquad_targets COMPONENT library)
install(TARGETS delquad_bench EXPORT delquad_bench_targets COMPONENT library)
install(DIRECTORY include/delquad DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/delquad)
install(EXPORT delquad_targets NAMESPACE delquad:: FILE delquad-targets.cmake DESTINATION ${folder} COMPONENT library)
install(EXPORT delquad_bench_targets NAMESPACE delquad:: FILE delquad-bench.cmake DESTINATION ${folder} COMPONENT library)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/delquad-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/delquad-config.cmake ${CMAKE_BINARY_DIR}/delquad-config-version.cmake DESTINATION ${folder} COMPONENT library)
