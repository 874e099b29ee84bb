# SPDX-License-Identifier: GPL-3.0-or-later
# DELQUAD_CAD: AUTO takes OpenCASCADE if it is installed, ON insists, OFF builds without it.
set(DELQUAD_CAD AUTO CACHE STRING "Read STEP and BREP with OpenCASCADE: AUTO, ON or OFF")
set_property(CACHE DELQUAD_CAD PROPERTY STRINGS AUTO ON OFF)
if(DELQUAD_CAD STREQUAL "ON")
  find_package(OpenCASCADE CONFIG GLOBAL REQUIRED)
elseif(DELQUAD_CAD STREQUAL "AUTO")
  find_package(OpenCASCADE CONFIG GLOBAL QUIET)
endif()

if(OpenCASCADE_FOUND AND TARGET TKSTEP AND NOT DELQUAD_CAD STREQUAL "OFF")
  # The kernel: a library that the program loads when it needs it, and what the helper program that reads CAD takes of it.
  target_compile_definitions(delquad_geometry_cad PRIVATE DELQUAD_HAS_CAD)
  file(GLOB sources CONFIGURE_DEPENDS geometry/cad/*.cpp geometry/cad/examples/*.cpp)
  list(FILTER sources EXCLUDE REGEX "(_main|load_kernel|find_worker|example_models)\\.cpp$")
  add_library(delquad_cad_kernel STATIC ${sources})
  target_include_directories(delquad_cad_kernel SYSTEM PUBLIC ${OpenCASCADE_INCLUDE_DIR})
  target_link_libraries(delquad_cad_kernel PRIVATE delquad_flags
    PUBLIC fmt::fmt Threads::Threads TKIGES TKSTEP TKSTEPBase TKXSBase TKMesh TKOffset TKFillet TKBO TKPrim TKShHealing
           TKTopAlgo TKGeomAlgo TKGeomBase TKBRep TKG3d TKG2d TKMath TKernel)
  delquad_common_headers(delquad_cad_kernel OFF)
  add_library(delquad_kernel MODULE geometry/cad/kernel_main.cpp)
  target_link_libraries(delquad_kernel PRIVATE delquad_flags delquad_cad_kernel delquad_library)
  set_target_properties(delquad_kernel PROPERTIES OUTPUT_NAME delquad-kernel)
  add_executable(delquad_cad geometry/cad/worker_main.cpp)
  # Loading all of OpenCASCADE takes 40 ms, the part that reads files 27 ms.
  target_link_options(delquad_cad PRIVATE LINKER:--as-needed)
  target_link_libraries(delquad_cad PRIVATE delquad_flags delquad_cad_kernel delquad_geometry_cad delquad_base delquad_geometry_mesh delquad_geometry_planar
                        delquad_geometry_surface)
  set_target_properties(delquad_cad PROPERTIES OUTPUT_NAME delquad-cad RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  set_property(GLOBAL APPEND PROPERTY DELQUAD_LOADED delquad_kernel delquad_cad)
  set(DELQUAD_HAS_CAD ON PARENT_SCOPE)
  set(DELQUAD_OCCT_VERSION ${OpenCASCADE_VERSION} PARENT_SCOPE)
else()
  message(STATUS "OpenCASCADE: not used; STEP and BREP files cannot be read")
  set(DELQUAD_HAS_CAD OFF PARENT_SCOPE)
  set(DELQUAD_OCCT_VERSION "not used" PARENT_SCOPE)
endif()
