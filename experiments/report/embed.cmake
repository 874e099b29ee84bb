# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the parts of the page as string literals: script -DFOLDER= -DOUTPUT=.
# Compilers need not take literals that long, but all do.
set(text "#include \"experiments/report/page_json.h\"\n\n#pragma GCC diagnostic ignored \"-Woverlength-strings\"\n\nnamespace delquad {\n")
function(embed name)
  set(content "")
  foreach(file ${ARGN})
    file(READ ${FOLDER}/${file} part)
    string(APPEND content "${part}\n")
  endforeach()
  string(FIND "${content}" ")embedded\"" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${ARGN}: holds the end of the literal")
  endif()
  set(text "${text}\nconst std::string_view ${name} = R\"embedded(${content})embedded\";\n" PARENT_SCOPE)
endfunction()
embed(kPageStyle page/report.css)
embed(kPageBody page/body.html)
embed(kViewStyle page/view.css)
embed(kViewBody page/view.html)
# In the order in which they use each other.
embed(kPageScript page/dom.js page/colours.js page/packed_mesh.js page/svg_pen.js page/pdf.js page/figure.js page/table.js
      page/charts.js page/spread.js page/gestures.js page/plane_view.js page/space_view.js page/sheet.js)
embed(kReportScript page/report.js)
embed(kViewScript page/view.js)
embed(kThreeScript three/three.min.js)
file(WRITE ${OUTPUT} "${text}\n}  // namespace delquad\n")
