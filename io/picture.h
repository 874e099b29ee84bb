#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "io/svg.h"

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

struct IrregularVertex {
  int vertex;
  int valence;  ///< on the boundary, where it is that of a pair, as inside: 3 or 5
  double size;  ///< mean of the sizes of the elements around it
};

/// What pictures show.
struct IrregularVertices {
  std::vector<IrregularVertex> vertices;  ///< ascending
  std::vector<std::array<int, 2>> pairs;  ///< of a mesh of quads, see pair_irregular()
};

/// Vertices inside the mesh (not on its free edges) whose valence is not `regular`, and those of pairs.
/// element_size: by element, triangles first.
IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size);

/// What pictures of meshes share. Elements of about one size have one width of their edges: its step, by the
/// element's size in pixels.
int step_of_width(double pixels);
void add_elements(svg::Picture& picture, const svg::Path& elements, const std::string& fill, int step,
                  bool with_edges);
/// Dots on irregular vertices that are seen and lines that join pairs of them, with their legend, below that
/// of eta. pixels: the size of each element.
void add_irregular(svg::Picture& picture, const Mesh& mesh, int regular, const std::vector<double>& pixels,
                   const std::function<bool(const Vec3&)>& is_seen);

}  // namespace delquad
