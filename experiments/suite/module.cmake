# The list of the suite's models, as text inside the program.
set(list experiments/suite/models.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
file(READ ${list} DELQUAD_SUITE)
configure_file(experiments/suite/suite_text.cpp.in ${PROJECT_BINARY_DIR}/suite_text.cpp @ONLY)
target_sources(delquad_experiments_suite PRIVATE ${PROJECT_BINARY_DIR}/suite_text.cpp)
