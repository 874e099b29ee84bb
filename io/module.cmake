find_package(Boost REQUIRED)
find_package(PkgConfig REQUIRED)

# The font of figures, as bytes inside the program.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS io/font/dejavu_sans.ttf)
file(READ io/font/dejavu_sans.ttf font HEX)
string(REGEX REPLACE "(..)" "0x\\1," font "${font}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/sans_font.cpp @ONLY CONTENT [[
#include <span>
namespace delquad {
extern const std::span<const unsigned char> kSansFont;
constexpr unsigned char kBytes[] = {@font@};
const std::span<const unsigned char> kSansFont = kBytes;
}  // namespace delquad
]])
target_sources(delquad_io PRIVATE ${PROJECT_BINARY_DIR}/sans_font.cpp)

# Formats by libraries of other projects, if these are installed: DELQUAD_HAS_<FORMAT>, and a library of ours for each, which is loaded
# when needed. Each sees its own headers alone: Debian builds MED with the HDF5 of Open MPI, whose headers differ from the serial ones.
# The symbols of both have versions.
function(delquad_format_library format header library)
  string(TOUPPER ${format} name)
  find_path(DELQUAD_${name}_INCLUDE ${header} PATH_SUFFIXES hdf5/serial)
  find_library(DELQUAD_${name}_LIBRARY ${library} PATH_SUFFIXES hdf5/serial)
  mark_as_advanced(DELQUAD_${name}_INCLUDE DELQUAD_${name}_LIBRARY)
  foreach(needed IN ITEMS ${DELQUAD_${name}_INCLUDE} ${DELQUAD_${name}_LIBRARY} ${ARGN})
    if(NOT needed)
      message(STATUS "No files of ${format}: its library is missing")
      return()
    endif()
  endforeach()
  set_property(SOURCE io/library_formats.cpp APPEND PROPERTY COMPILE_DEFINITIONS DELQUAD_HAS_${name})
  add_library(delquad_${format} MODULE io/libraries/${format}.cpp)
  set_target_properties(delquad_${format} PROPERTIES OUTPUT_NAME delquad-${format})
  delquad_common_headers(delquad_${format} ON)
  target_link_libraries(delquad_${format} PRIVATE delquad_flags fmt::fmt delquad_library ${DELQUAD_${name}_LIBRARY})
  foreach(folder IN ITEMS ${ARGN} ${DELQUAD_${name}_INCLUDE})
    if(NOT folder STREQUAL "/usr/include")
      target_compile_options(delquad_${format} PRIVATE "-isystem${folder}")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY DELQUAD_LOADED delquad_${format})
endfunction()
delquad_format_library(exodus exodusII.h exoIIv2c)
delquad_format_library(cgns cgnslib.h cgns)
delquad_format_library(ugrid netcdf.h netcdf)
delquad_format_library(xdmf hdf5.h hdf5)
find_path(DELQUAD_MPI_INCLUDE mpi.h PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openmpi/include)
find_path(DELQUAD_HDF5_MPI_INCLUDE hdf5.h PATHS /usr/include/hdf5/openmpi NO_DEFAULT_PATH)
mark_as_advanced(DELQUAD_MPI_INCLUDE DELQUAD_HDF5_MPI_INCLUDE)
delquad_format_library(med med.h medC ${DELQUAD_HDF5_MPI_INCLUDE} ${DELQUAD_MPI_INCLUDE})
