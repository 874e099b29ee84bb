// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "delquad/mesher.h"
#include "geometry/patches/meshing_setup.h"

// This header compares a mesh with the given one. The pipeline uses it, so that nothing gets worse.

namespace delquad {

/// Returns the worst values of a mesh: eta, shortest edge in sizes, aspect. Planar meshes are seen from
/// above.
GivenWorst worst_of_given(const Mesh& mesh, bool is_in_plane, const SizeField& size);

/// Returns whether a quad is worse than the worst given one. It is also beyond if its eta is below 0.2 and
/// below the worst eta of sound given quads.
bool is_beyond_given(const MeshingSetup& prepared, const std::array<Vec3, 4>& corners);

/// Returns a given mesh with the worst values that it had before its unsound quads were opened.
MeshResult as_it_was(MeshResult given, const GivenWorst& worst);

/// Factors by which a mesh got worse: worst angle (eta), shortest edge (in sizes), largest aspect, number of
/// quads. The number counts if it differs by more than a tenth. They are logarithms, and 0 if a value is not
/// worse.
struct Degradation {
  double eta, side, aspect, number;
  double sum() const { return eta + side + aspect + number; }
};
/// Returns the factors from `before` to `after`.
Degradation degradation_of(const MeshResult& after, const MeshResult& before);

/// Returns whether a worse value comes from a poor quad, see poor_quads.h, or from the number of quads.
bool costs_too_much(const MeshResult& after, const MeshResult& before);

/// Returns the loss of quality by which soundness was bought, with its place: "the worst eta goes from ...;
/// ...".
std::string text_of_price(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

}  // namespace delquad
