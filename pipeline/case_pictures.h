#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/prepare.h"

namespace delquad {

/// Draws the fields of a case: folder/cross.svg and folder/size.svg.
void draw_case(const PreparedCase& prepared, const std::string& name, const std::filesystem::path& folder);

/// eta of every cell in the order of VTU files (lines, triangles, quads); 0 where it has no meaning.
std::vector<double> cell_etas(const Mesh& mesh);

}  // namespace delquad
