// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "delquad/extend.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/surface/surface_model.h"

// This header makes a surface of a given mesh in space. The preparation uses it.

namespace delquad {

/// Default feature angle of given meshes in degrees, as for triangulations.
inline constexpr double kGivenFeatureAngle = 40;

/// A mesh in space as a surface: its elements, quads as two triangles, are the fine triangulation.
struct GivenSurface {
  SurfaceModel model;
  std::vector<int> element;  ///< element of each fine triangle; triangles come first
  /// Corners of each element, points of the fine triangulation; the last one of a triangle is -1.
  std::vector<std::array<int, 4>> corners;
  std::vector<int> given_curve, given_region;  ///< as in KeptModel
  std::vector<char> avoided = {};              ///< as in FlattenOptions
};

/// Returns whether the elements do not all lie in one plane of constant z.
bool is_in_space(const Mesh& mesh);

/// Returns a given mesh as a surface. Faces end at lines, at edges of one element or of more than two,
/// between regions, and at edges sharper than the feature angle (degrees). All nodes there stay, and so does
/// each named point. Throws InputError, with places, for one-sided surfaces and for meshes that are not
/// conforming. These have hanging nodes, or elements that are repeated, have a corner twice or no area. Quads
/// that are inverted, folded or without area are repaired first, by nodes that may move over the other
/// elements.
GivenSurface make_given_surface(const GivenMesh& given, double feature_angle);

/// Returns the elements of a patch, with points of its boundary first. `inside` gets the places in space of
/// the other points.
QuadPatch elements_within(const GivenSurface& surface, const SurfacePatch& patch, std::vector<Vec3>& inside);

/// Returns the domain of a model whose curves keep all their points as nodes. No stage moves a node that is
/// on no cut. The k-th point of a patch's boundary is the vertex of its map at which the k-th side of its
/// outline begins. Warnings name patches with an odd boundary.
SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size);

}  // namespace delquad
