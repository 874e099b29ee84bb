#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesher.h"

namespace delquad {

/// Draws the fields of a case: folder/cross.svg and folder/size.svg; of a size that is the same everywhere,
/// the outline and the number.
void draw_case(const Prepared& prepared, const std::string& name, const std::filesystem::path& folder);

/// The energy at every evaluation of a smoothing, as its summary has them: a curve for each patch and each
/// time that the frames were taken, dots where the points went on.
void draw_convergence(const std::filesystem::path& path, const Summaries& summaries,
                      const std::string& title);

/// eta of every cell in the order of VTU files (lines, triangles, quads); 0 where it has no meaning.
std::vector<double> cell_etas(const Mesh& mesh);

}  // namespace delquad
