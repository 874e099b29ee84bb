#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A cross to draw: where, which way (radians) and how large.
struct CrossGlyph {
  Vec2 at;
  double theta;
  double length;
};

struct SingularityMark {
  Vec2 at;
  int index;  ///< in quarters: +1 valence 3, -1 valence 5
};

/// The planar mesh coloured by eta (quads) or plain (triangles), irregular interior vertices marked by
/// valence, with a legend and a title line. SVG, written whole or not at all.
void draw_mesh(const std::filesystem::path& path, const Mesh& mesh, const std::string& title);
/// A mesh of a surface in space: a shaded view, in parallel projection from the corner of a cube around it
/// from which most of it is seen, z upright. Quads are coloured by eta, triangles by region when there are no
/// quads. Curves, free edges and irregular vertices are drawn where they are seen.
void draw_surface(const std::filesystem::path& path, const Mesh& mesh, const std::string& title);
/// The cross field: glyphs inside the mesh's outline, singularities marked.
void draw_crosses(const std::filesystem::path& path, const Mesh& outline,
                  const std::vector<CrossGlyph>& crosses, const std::vector<SingularityMark>& singularities,
                  const std::string& title);
/// A scalar at the points of a triangle mesh, log-coloured, with a legend.
void draw_scalar(const std::filesystem::path& path, const Mesh& triangles, const std::vector<double>& values,
                 const std::string& title);

}  // namespace delquad
