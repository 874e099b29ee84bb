// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/meshing.h"

namespace delquad {

inline MeshResult improve_given(const Mesh& given, const std::string& word) {
  return mesh(problem_of(GivenMesh{given}), word);
}

/// Each quad as two triangles, along one diagonal or, every so many, the other.
inline Mesh halved(Mesh mesh, std::size_t every) {
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto [a, b, c, d] = mesh.quads[q];
    const bool other = q % every == 0;
    mesh.triangles.push_back(other ? std::array{a, b, d} : std::array{a, b, c});
    mesh.triangles.push_back(other ? std::array{b, c, d} : std::array{a, c, d});
    mesh.triangle_region.insert(mesh.triangle_region.end(), 2, mesh.quad_region[q]);
  }
  mesh.quads.clear();
  mesh.quad_region.clear();
  return mesh;
}

inline void expect_same_entities(const std::vector<Entity>& a, const std::vector<Entity>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].tag, b[i].tag);
    EXPECT_EQ(a[i].names, b[i].names);
  }
}

}  // namespace delquad
