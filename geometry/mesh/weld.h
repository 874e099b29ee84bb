#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Points of `mesh` by the names they should go by: name[i] is i or a smaller index.
using PointNames = std::vector<int>;

/// Each point goes by the first with the same coordinates.
PointNames names_of_equal_points(const Mesh& mesh);
/// Ends of edges that one triangle or quad only uses go by the nearest of the earlier ones within `tolerance`
/// (a length) that keep their own name; all other points keep theirs.
PointNames names_at_open_edges(const Mesh& mesh, double tolerance);

/// Elements name their vertices anew. They may end with a repeated vertex or on each other, and points
/// unused.
void rename_points(Mesh& mesh, const PointNames& names);

}  // namespace delquad
