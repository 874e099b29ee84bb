#pragma once

#include <STEPControl_Reader.hxx>

#include <map>
#include <string>
#include <vector>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// A STEP file of which a part is missing.
struct StepRest {
  std::vector<std::string> lost;  ///< "#9, which #7 (EDGE_CURVE) needs, is not defined"; empty: all is there
  std::vector<int> faces;         ///< numbers of those that need it
  bool ends_early = false;
  bool is_whole = false;  ///< only curves in parameters are missing, which can be made anew
  std::string text;       ///< the file without all that; empty: nothing is lost, or no face is left
};

/// Finds entities that are used and not defined, and where a file ends too early. `unreadable`: others that
/// are no use, with the reason. What needs one of them goes: edges lose curves in parameters alone, else
/// whole faces go, and solids only with their last one. Faces and shells whose solid is missing become a
/// surface, if it is clear of which representation. What no face needs may be missing, and stays as it is.
StepRest rest_of_step(const std::string& text, const std::map<int, std::string>& unreadable = {});

/// Names and colours of the faces that `reader` has transferred, in the order of the file: those of faces,
/// shells, solids and products; and the names of its edges.
/// `is_ascii`: the file has no other bytes, which the kernel would have taken for ISO 8859-1. `warnings`
/// receives what other bytes were taken for.
PartNames step_names(const STEPControl_Reader& reader, bool is_ascii, std::vector<Warning>& warnings);

}  // namespace delquad::cad
