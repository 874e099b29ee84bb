// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <XSControl_Reader.hxx>
#include <string>
#include <vector>

// This header names parts of a file that were lost. The reader of CAD uses it.

namespace delquad::cad {

/// Parts of a file that did not become shapes, each with place and reason.
struct LostShapes {
  std::vector<std::string> damaged;   ///< parts without which the model is incomplete
  std::vector<std::string> unused;    ///< faces that no shape of the file has
  std::vector<std::string> doubtful;  ///< parts that became shapes with errors
};

/// Returns the losses of a STEP or IGES reader whose roots are transferred. They are unreadable parts of
/// faces ("#17 (Direction): ..."; in IGES "D23", a number of the directory), and parts without a face.
LostShapes lost_shapes(XSControl_Reader& reader);

/// Returns the unreadable parts of a loaded file that faces need, each with number and reason, without shells
/// that lack faces.
std::vector<std::string> unreadable_parts(XSControl_Reader& reader);

/// Returns the errors in a BREP file's text ("line 12: '3..5' is no number"), of which `n_faces` faces were
/// read.
std::vector<std::string> lost_in_brep(const std::string& text, int n_faces);

}  // namespace delquad::cad
