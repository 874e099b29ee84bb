// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/local_remeshing.h"
#include "algorithms/treatment/treatment.h"
#include "algorithms/treatment/treatment_moves.h"
#include "smoothing/relocation/quad_relocation.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

/// Stages on quads, with checks of what must hold for any input.
namespace delquad::testing_support {

inline QuadPatch matched(const PatchBoundary& boundary, const ParametricSize& size,
                         const CrossField& cross = FunctionCross(0.3),
                         const PointPlacement& placement = *make_linf_delquad()) {
  return recombine(mesh_frontal(boundary, placement, cross, size), *make_primal_dual_solver());
}

/// Two quads around the middle of a square of side 2.
inline QuadPatch doublet() {
  QuadPatch mesh;
  mesh.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}};
  mesh.quads = {{0, 1, 2, 4}, {0, 4, 2, 3}};
  mesh.n_boundary = 4;
  return mesh;
}

/// Sum of (valence - ideal)^2.
inline int valence_energy(const QuadTopology& topology, const ValenceEnergy& energy) {
  int sum = 0;
  for (int v = 0; v < topology.vertex_slots(); ++v)
    if (topology.vertex_alive(v)) sum += energy.of(v);
  return sum;
}
inline int valence_energy(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  return valence_energy(topology, ValenceEnergy(topology));
}

/// Part of the interior vertices that have four quads.
inline double regular_share(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  int regular = 0, interior = 0;
  for (int v = mesh.n_boundary; v < topology.vertex_slots(); ++v, ++interior)
    regular += topology.valence(v) == 4;
  return double(regular) / interior;
}

inline void expect_same(const QuadPatch& a, const QuadPatch& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quads, b.quads);
}

inline QuadPatch treated(const QuadPatch& mesh, const PatchBoundary& boundary, const ParametricSize& size) {
  TreatmentSummary summary;
  const QuadPatch result = treat_paper(mesh, size, {}, &summary);
  expect_sound(result, boundary);
  EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
  // Doublets and diamonds take one quad each, openings add two.
  EXPECT_EQ(static_cast<int>(result.quads.size()) - static_cast<int>(mesh.quads.size()),
            summary.ring_quads + 2 * summary.openings - summary.diamonds - summary.doublets);
  return result;
}

inline QuadPatch regular(const QuadPatch& mesh, const PatchBoundary& boundary, const ParametricSize& size,
                         const RegularityOptions& options = {}, RegularitySummary* summary = nullptr) {
  RegularitySummary own;
  const QuadPatch result = make_regular(mesh, size, options, &own);
  expect_sound(result, boundary);
  EXPECT_EQ(result.triangles.size(), mesh.triangles.size());
  EXPECT_GE(worst_sine(result), std::min(worst_sine(mesh), sine_of_eta(kFloorEta)));
  EXPECT_EQ(own.irregular_before, count_irregular(mesh));
  EXPECT_EQ(own.irregular_after, count_irregular(result));
  EXPECT_LE(own.irregular_after + own.accepted, own.irregular_before);
  if (own.accepted == 0) expect_same(result, mesh);
  expect_same(make_regular(mesh, size, options), result);
  if (summary != nullptr) *summary = own;
  return result;
}

/// By stage C.
inline QuadPatch cleaned(const QuadPatch& mesh, const ParametricSize& size) {
  return make_regular(mesh, size, without_price({}));
}
inline QuadPatch cleaned(const QuadPatch& mesh, const PatchBoundary& boundary, const ParametricSize& size,
                         RegularitySummary* summary = nullptr) {
  return regular(mesh, boundary, size, without_price({}), summary);
}

}  // namespace delquad::testing_support
