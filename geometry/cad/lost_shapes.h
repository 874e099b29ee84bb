// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <XSControl_Reader.hxx>
#include <string>
#include <vector>

// This header names parts of a file that were lost. The reader of CAD uses it.

namespace delquad::cad {

/// Parts of a file that did not become shapes, each with its place and the reason.
struct LostShapes {
  std::vector<std::string> damaged;   ///< the model without them is not what was written
  std::vector<std::string> unused;    ///< faces that no shape of the file has
  std::vector<std::string> doubtful;  ///< became shapes, but not without errors
};

/// Returns the losses of a STEP or IGES reader whose roots are transferred. These are parts of faces that
/// cannot be read ("#17 (Direction): ..."; in IGES numbers of the directory, "D23"), and parts that gave no
/// face.
LostShapes lost_shapes(XSControl_Reader& reader);

/// Returns the parts of a loaded file that faces need and that cannot be read, each with its number and the
/// reason. Shells of which faces are missing are not among them.
std::vector<std::string> unreadable_parts(XSControl_Reader& reader);

/// Returns the errors in a BREP file's text ("line 12: '3..5' is no number"), of which `n_faces` faces were
/// read.
std::vector<std::string> lost_in_brep(const std::string& text, int n_faces);

}  // namespace delquad::cad
