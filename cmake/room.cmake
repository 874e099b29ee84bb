# A room of the house: the folder that calls this as one static library of all its sources, such as
# delquad::geometry_planar for geometry/planar. LINKS: the rooms whose headers it includes, and no others;
# tests/house checks both. PRIVATE: libraries. EXCLUDE, ONLY: sources. FOLDERS: inside of
# it, whose sources are its own.
function(delquad_room)
  cmake_parse_arguments(ARG "" "" "LINKS;PRIVATE;EXCLUDE;ONLY;FOLDERS" ${ARGN})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REPLACE "/" "_" name ${folder})
  list(TRANSFORM ARG_FOLDERS APPEND "/*.cpp")
  file(GLOB sources RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS *.cpp ${ARG_FOLDERS})
  list(REMOVE_ITEM sources ${ARG_EXCLUDE} "")
  if(ARG_ONLY)
    set(sources ${ARG_ONLY})
  endif()
  add_library(delquad_${name} STATIC ${sources})
  add_library(delquad::${name} ALIAS delquad_${name})
  set_target_properties(delquad_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(delquad_${name} PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  string(REPLACE "/" "_" links "${ARG_LINKS}")
  list(TRANSFORM links PREPEND delquad::)
  target_link_libraries(delquad_${name} PUBLIC ${links} PRIVATE delquad_flags ${ARG_PRIVATE})
  if(TARGET delquad_bench)  # which stands on the shared library, not on copies of its rooms
    target_sources(delquad_bench PRIVATE $<TARGET_OBJECTS:delquad_${name}>)
    target_link_libraries(delquad_bench PRIVATE ${ARG_PRIVATE})
  endif()
endfunction()
