#include "algorithms/recombination/chord_split.h"

#include <algorithm>

namespace delquad {

namespace {

void replace_neighbour(TriPatch& tri, int t, int from, int to) {
  if (t < 0) return;
  auto& n = tri.neighbours[t];
  *std::find(n.begin(), n.end(), from) = to;
}

void split_side(TriPatch& tri, int t, int side) {
  const int u = tri.neighbours[t][side];
  const auto& n = tri.neighbours[u];
  const int facing = static_cast<int>(std::find(n.begin(), n.end(), t) - n.begin());
  const int c = tri.triangles[t][side], a = tri.triangles[t][(side + 1) % 3],
            b = tri.triangles[t][(side + 2) % 3];
  const int d = tri.triangles[u][facing];
  const int bc = tri.neighbours[t][(side + 1) % 3], ca = tri.neighbours[t][(side + 2) % 3];
  const int ad = tri.neighbours[u][(facing + 1) % 3], db = tri.neighbours[u][(facing + 2) % 3];

  const int m = static_cast<int>(tri.points.size());
  const int t2 = static_cast<int>(tri.triangles.size()), u2 = t2 + 1;
  tri.points.push_back(0.5 * (tri.points[a] + tri.points[b]));
  tri.triangles[t] = {c, a, m};
  tri.neighbours[t] = {u, t2, ca};
  tri.triangles[u] = {d, m, a};
  tri.neighbours[u] = {t, ad, u2};
  tri.triangles.push_back({c, m, b});
  tri.neighbours.push_back({u2, bc, t});
  tri.triangles.push_back({d, b, m});
  tri.neighbours.push_back({t2, u, db});
  replace_neighbour(tri, bc, t, t2);
  replace_neighbour(tri, db, u, u2);
}

/// An interior side of t between two boundary points, -1 when it has none.
int chord_of(const TriPatch& tri, int t) {
  for (int side = 0; side < 3; ++side) {
    if (tri.neighbours[t][side] >= 0 && tri.triangles[t][(side + 1) % 3] < tri.n_boundary &&
        tri.triangles[t][(side + 2) % 3] < tri.n_boundary) {
      return side;
    }
  }
  return -1;
}

}  // namespace

int split_chords(TriPatch& tri) {
  int cuts = 0;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int side = chord_of(tri, static_cast<int>(t)); side >= 0;
         side = chord_of(tri, static_cast<int>(t))) {
      split_side(tri, static_cast<int>(t), side);
      ++cuts;
    }
  }
  return cuts;
}

}  // namespace delquad
