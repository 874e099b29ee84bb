# SPDX-License-Identifier: GPL-3.0-or-later
# The modules of the library, from the bottom to the top: each links only modules above its line here. LINKS: the modules whose
# headers it includes; tests/house checks both. PRIVATE: libraries of other projects. COLD: nothing in it takes time, so that it
# is compiled by -Og, which takes a third less time than -O2. HOT: its inner loops gain by -O3. All others are compiled by -O2.
# FOLDERS: folders inside it whose sources are its own. ONLY: its sources, if these are not all of the folder.
# A file module.cmake in the folder adds generated sources and optional libraries.
function(delquad_module folder)
  cmake_parse_arguments(ARG "COLD;HOT" "" "LINKS;PRIVATE;ONLY;FOLDERS" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  if(DELQUAD_MODULES AND NOT folder IN_LIST DELQUAD_MODULES)
    return()
  endif()
  list(TRANSFORM ARG_FOLDERS PREPEND ${folder}/)
  set(patterns ${folder} ${ARG_FOLDERS})
  list(TRANSFORM patterns APPEND "/*.cpp")
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  list(FILTER sources EXCLUDE REGEX "/(worker_)?main\\.cpp$")
  if(ARG_ONLY)
    list(TRANSFORM ARG_ONLY PREPEND ${folder}/ OUTPUT_VARIABLE sources)
  endif()
  add_library(delquad_${name} OBJECT ${sources})
  target_link_libraries(delquad_${name} PRIVATE delquad_flags fmt::fmt Threads::Threads ${ARG_PRIVATE})
  if(ARG_HOT)
    target_compile_options(delquad_${name} PRIVATE $<$<CONFIG:Release>:-O3>)
  else()
    delquad_common_headers(delquad_${name} ${ARG_COLD})
  endif()
  if(ARG_COLD)  # linked last: of a template that several modules instantiate, the linker takes the first
    cmake_language(EVAL CODE "cmake_language(DEFER CALL target_link_libraries ${DELQUAD_INTO} PRIVATE delquad_${name})")
  else()
    target_link_libraries(${DELQUAD_INTO} PRIVATE delquad_${name})
  endif()
  include(${folder}/module.cmake OPTIONAL)
endfunction()

# Compiles the headers that nearly every source includes once for all targets with the same optimization. Without unity builds each
# source has to include its headers itself.
function(delquad_common_headers target is_cold)
  if(is_cold)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
  endif()
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set(owner delquad_headers)
  if(is_cold)
    set(owner delquad_headers_cold)
  endif()
  if(NOT TARGET ${owner})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${owner}.cpp CONTENT "")
    add_library(${owner} OBJECT ${PROJECT_BINARY_DIR}/${owner}.cpp)
    target_link_libraries(${owner} PRIVATE delquad_flags fmt::fmt Threads::Threads)
    if(is_cold)
      target_compile_options(${owner} PRIVATE $<$<CONFIG:Release>:-Og>)
    endif()
    target_precompile_headers(${owner} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/common_headers.h)
    if(is_cold)
      target_link_libraries(${owner} PRIVATE nlohmann_json::nlohmann_json)
      target_precompile_headers(${owner} PRIVATE <nlohmann/json.hpp>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# A shared library of the modules that follow.
function(delquad_shared target output_name)
  add_library(${target} SHARED)
  target_link_libraries(${target} PRIVATE delquad_flags)
  if(NOT DELQUAD_SANITIZE)
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${output_name} LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION})
  set(DELQUAD_INTO ${target} PARENT_SCOPE)
endfunction()

delquad_shared(delquad_library delquad)
delquad_module(base PRIVATE CGAL::CGAL TBB::tbb ${CMAKE_DL_LIBS})
delquad_module(base/matching HOT LINKS base)
delquad_module(geometry/mesh LINKS base PRIVATE CGAL::CGAL)
delquad_module(geometry/planar LINKS base geometry/mesh PRIVATE Eigen3::Eigen)
delquad_module(geometry/surface LINKS base geometry/mesh geometry/planar PRIVATE Eigen3::Eigen)
delquad_module(geometry/cad ONLY example_models.cpp find_worker.cpp load_kernel.cpp LINKS base geometry/mesh geometry/surface PRIVATE
               ${CMAKE_DL_LIBS})
delquad_module(algorithms/fields LINKS base geometry/mesh PRIVATE CGAL::CGAL Eigen3::Eigen)
delquad_module(algorithms/fields/surface LINKS base geometry/mesh geometry/surface algorithms/fields)
delquad_module(geometry/patches LINKS base base/matching geometry/mesh geometry/planar geometry/surface algorithms/fields
               algorithms/fields/surface)
delquad_module(smoothing/relocation HOT LINKS base geometry/mesh algorithms/fields)
delquad_module(smoothing/cvt HOT LINKS base geometry/mesh algorithms/fields PRIVATE CGAL::CGAL Ceres::ceres)
delquad_module(smoothing/optimisation HOT LINKS base geometry/mesh geometry/planar algorithms/fields smoothing/relocation PRIVATE
               Ceres::ceres)
delquad_module(smoothing/surface HOT LINKS base geometry/mesh algorithms/fields geometry/patches smoothing/optimisation)
delquad_module(metrics LINKS base geometry/mesh algorithms/fields)
delquad_module(metrics/surface LINKS base geometry/mesh geometry/surface algorithms/fields metrics)
delquad_module(metrics/solve LINKS base geometry/mesh metrics PRIVATE Eigen3::Eigen)
delquad_module(algorithms/insertion LINKS base geometry/mesh algorithms/fields PRIVATE CGAL::CGAL)
delquad_module(algorithms/recombination LINKS base base/matching geometry/mesh)
delquad_module(algorithms/treatment LINKS base base/matching geometry/mesh algorithms/fields smoothing/relocation algorithms/recombination)
delquad_module(algorithms/regularity LINKS base geometry/mesh algorithms/fields smoothing/relocation algorithms/treatment)
delquad_module(algorithms/layout LINKS base base/matching geometry/mesh algorithms/fields smoothing/relocation smoothing/optimisation
               algorithms/insertion algorithms/recombination algorithms/treatment algorithms/regularity)
delquad_module(algorithms/finish LINKS base geometry/mesh geometry/patches algorithms/treatment smoothing/relocation smoothing/surface
               metrics
               metrics/surface)
delquad_module(io COLD FOLDERS formats LINKS base geometry/mesh metrics PRIVATE ZLIB::ZLIB EXPAT::EXPAT PkgConfig::libzip Boost::headers)
delquad_module(io/gdal COLD LINKS base io)
delquad_module(features/seed LINKS base geometry/planar algorithms/fields)
delquad_module(features/sizes LINKS base geometry/mesh geometry/planar geometry/surface algorithms/fields algorithms/fields/surface
               geometry/patches)
delquad_module(features/crosses LINKS base geometry/mesh geometry/surface algorithms/fields geometry/patches algorithms/insertion)
delquad_module(features/divisions COLD LINKS geometry/mesh geometry/planar geometry/patches features/sizes)
delquad_module(features/embedded COLD LINKS base geometry/mesh geometry/planar geometry/surface features/sizes)
delquad_module(features/symmetry COLD LINKS base geometry/mesh geometry/planar geometry/surface algorithms/fields geometry/patches
               features/divisions features/embedded PRIVATE
               Eigen3::Eigen)
delquad_module(features/periodic COLD LINKS base geometry/mesh geometry/planar geometry/surface geometry/patches features/sizes)
delquad_module(features/grids LINKS base base/matching geometry/mesh geometry/planar geometry/patches smoothing/relocation
               smoothing/optimisation
               metrics)
delquad_module(features/washers COLD LINKS base geometry/mesh geometry/planar geometry/surface algorithms/fields)
delquad_module(features/layers COLD LINKS base geometry/mesh geometry/planar geometry/patches features/sizes features/symmetry
               features/grids)
delquad_module(features/scaling COLD LINKS base geometry/mesh algorithms/fields geometry/patches features/layers)
delquad_module(features/thin COLD LINKS base geometry/mesh geometry/planar geometry/patches features/sizes)
delquad_module(features/naming COLD LINKS base geometry/mesh geometry/surface)
delquad_module(features/midsurface COLD LINKS base geometry/mesh geometry/surface PRIVATE Eigen3::Eigen)
delquad_module(io/cases COLD LINKS base geometry/mesh geometry/planar geometry/surface geometry/cad algorithms/fields io io/gdal
               features/layers
               PRIVATE PkgConfig::muparser tomlplusplus::tomlplusplus nlohmann_json::nlohmann_json)
delquad_module(metrics/judgement COLD LINKS base geometry/mesh geometry/patches metrics metrics/surface metrics/solve features/sizes
               features/symmetry features/layers)
delquad_module(features/given COLD LINKS base geometry/mesh geometry/planar geometry/surface geometry/patches metrics metrics/judgement
               features/embedded)
delquad_module(features/curved LINKS base geometry/mesh geometry/planar geometry/patches metrics features/symmetry features/layers
               PRIVATE Ceres::ceres)
delquad_module(features/volume LINKS base geometry/mesh metrics features/layers PRIVATE Eigen3::Eigen)
delquad_module(features/extrusion COLD LINKS base geometry/mesh metrics io PRIVATE Eigen3::Eigen)
delquad_module(features/curves COLD LINKS base base/matching geometry/mesh geometry/planar geometry/surface geometry/cad algorithms/fields
               algorithms/fields/surface
               geometry/patches features/seed features/sizes features/divisions features/embedded features/symmetry features/periodic
               features/grids features/layers features/thin features/naming)
delquad_module(features/metric LINKS base geometry/mesh geometry/planar geometry/surface algorithms/fields algorithms/fields/surface
               geometry/patches metrics
               features/seed features/curves)
delquad_module(mesher COLD LINKS base geometry/mesh geometry/planar geometry/surface geometry/cad algorithms/fields geometry/patches
               smoothing/cvt
               smoothing/optimisation smoothing/surface metrics metrics/surface algorithms/insertion algorithms/treatment
               algorithms/recombination algorithms/regularity algorithms/layout algorithms/finish io/cases
               features/seed features/sizes features/crosses features/divisions features/embedded features/symmetry features/periodic
               features/grids features/washers features/layers features/scaling features/thin features/given features/curved
               features/curves features/metric features/naming features/midsurface metrics/judgement)
delquad_module(mesher/adapt COLD LINKS base geometry/mesh algorithms/fields mesher PRIVATE Eigen3::Eigen)

if(DELQUAD_PROGRAMS)
  delquad_shared(delquad_bench delquad_bench)
  target_link_libraries(delquad_bench PUBLIC delquad_library)
  delquad_module(metrics/tables COLD LINKS base metrics metrics/solve io io/cases PRIVATE Boost::headers nlohmann_json::nlohmann_json)
  delquad_module(experiments/console COLD LINKS base io)
  delquad_module(experiments/sweep COLD LINKS base geometry/mesh geometry/cad mesher/adapt metrics metrics/surface metrics/solve
               metrics/judgement
                 metrics/tables algorithms/insertion io io/cases mesher experiments/console PRIVATE nlohmann_json::nlohmann_json)
  delquad_module(experiments/report COLD LINKS base geometry/mesh metrics metrics/tables io mesher experiments/sweep PRIVATE ZLIB::ZLIB
                 nlohmann_json::nlohmann_json)
  delquad_module(program COLD LINKS base geometry/mesh geometry/surface geometry/cad algorithms/fields metrics metrics/solve
                 metrics/judgement metrics/tables io io/cases features/extrusion features/volume mesher mesher/adapt experiments/console experiments/sweep
                 experiments/report PRIVATE CLI11::CLI11 nlohmann_json::nlohmann_json)
endif()
