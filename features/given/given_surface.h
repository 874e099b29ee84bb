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

/// Faces end at lines, edges of one element or of more than two, edges between regions and edges sharper than
/// the feature angle (degrees). All nodes there stay, and so does each named point. Throws InputError, naming
/// places, for surfaces with one side only, and for meshes that are not conforming. These have hanging nodes,
/// or elements that are there twice, have a corner twice or no area. Quads that are inverted, folded or
/// without area are repaired first, by moving nodes that need not stay over the other elements.
GivenSurface make_given_surface(const GivenMesh& given, double feature_angle);

/// Returns the elements of a patch, with points of its boundary first. `inside` gets the places in space of
/// the other points.
QuadPatch elements_within(const GivenSurface& surface, const SurfacePatch& patch, std::vector<Vec3>& inside);

/// Returns the domain of a model whose curves keep all their points as nodes. No stage moves a node that is
/// on no cut. The k-th point of a patch's boundary is the vertex of its map at which the k-th side of its
/// outline begins. Warnings name patches with an odd boundary.
SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size);

}  // namespace delquad
