# SPDX-License-Identifier: GPL-3.0-or-later
# The entries of the bibliography that captions of tables and figures cite.
set(bibliography docs/bibliography.bib)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${bibliography})
file(READ ${bibliography} text)
set(entries "")
foreach(key IN ITEMS dolan2002 hall1992 holm1979 tarone1990 wilcoxon1945)
  string(REGEX MATCH "@[a-z]+{${key},[^@]*}" entry "${text}")
  if(NOT entry)
    message(FATAL_ERROR "${bibliography}: has no entry ${key}")
  endif()
  string(APPEND entries "${entry}\n\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/bibliography.cpp @ONLY CONTENT [[
namespace delquad {
extern const char* const kBibliography;
const char* const kBibliography = R"bib(@entries@)bib";
}  // namespace delquad
]])
target_sources(delquad_metrics_tables PRIVATE ${PROJECT_BINARY_DIR}/bibliography.cpp)
