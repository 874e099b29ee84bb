// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "delquad/mesher.h"
#include "geometry/patches/meshing_setup.h"

// This header compares a mesh with the given one. The pipeline uses it, so that nothing gets worse.

namespace delquad {

/// Returns the worst values of a mesh. Planar meshes are seen from above.
GivenWorst worst_of_given(const Mesh& mesh, bool is_in_plane, const SizeField& size);

/// Returns whether a quad is worse than the worst given one, or below both a poor eta and the eta of the
/// worst sound one.
bool is_beyond_given(const MeshingSetup& prepared, const std::array<Vec3, 4>& corners);

/// Returns a given mesh with what was worst in it before its unsound quads were opened.
MeshResult as_it_was(MeshResult given, const GivenWorst& worst);

/// How many times the worst angle (eta), the shortest edge (in sizes), the largest aspect, and a differing
/// number of quads are worse. The number counts if it differs by more than a tenth. Logarithms, 0 where they
/// are not worse.
struct Degradation {
  double eta, side, aspect, number;
  double sum() const { return eta + side + aspect + number; }
};
Degradation degradation_of(const MeshResult& after, const MeshResult& before);

/// Returns whether the worse value comes from a poor quad, see poor_quads.h, or from the number of quads.
bool costs_too_much(const MeshResult& after, const MeshResult& before);

/// Returns the loss of quality that soundness costs, with its place: "the worst eta goes from ...; ...".
std::string text_of_price(const MeshingSetup& prepared, const MeshResult& after, const MeshResult& before);

}  // namespace delquad
