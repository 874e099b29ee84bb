// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header draws meshes as SVG. Experiments, reports and the table of formats use it.

namespace delquad {

/// Draws a mesh as SVG, written whole or not at all, with a title and a legend. Quads are colored by eta,
/// triangles by region if there are no quads. Curves, free edges and irregular vertices are drawn, by
/// valence. In space it is a shaded view, in parallel projection, z upright. It is seen from the corner of a
/// cube around it that shows most of it.
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

/// Vertices inside the mesh (not on its free edges) whose valence is not `regular`, and vertices of pairs.
/// element_size: by element, triangles first.
IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size);

}  // namespace delquad
