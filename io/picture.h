// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header draws meshes as SVG. Experiments, reports and the table of formats use it.

namespace delquad {

/// Draws a mesh as SVG, with a title and a legend, completely or not at all. Quads are colored by eta;
/// without quads triangles are colored by region. Curves, free edges and irregular vertices are drawn. A mesh
/// in space is shaded, in parallel projection with z up, from the corner of a surrounding cube that shows
/// most of it. Throws InputError if the file cannot be written.
void draw_mesh(const std::filesystem::path& path, const Mesh& mesh, const std::string& title);

struct IrregularVertex {
  int vertex;
  int valence;  ///< on the boundary, or inside in a pair: 3 or 5
  double size;  ///< mean of the sizes of the elements around it
};

/// Irregular vertices that pictures show.
struct IrregularVertices {
  std::vector<IrregularVertex> vertices;  ///< ascending
  std::vector<std::array<int, 2>> pairs;  ///< of a mesh of quads, see pair_irregular()
};

/// Returns vertices inside the mesh (not on its free edges) whose valence is not `regular`, and vertices of
/// pairs. `element_size` has a size for each element, triangles first.
IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size);

}  // namespace delquad
