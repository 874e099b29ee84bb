// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <utility>
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
  std::vector<int> given_point;                ///< point of the mesh for each fine point
  std::vector<char> avoided = {};              ///< as in FlattenOptions
};

/// Corners of the halves of a quad, counted from 0.
using QuadHalves = std::array<std::array<int, 3>, 2>;
/// Returns the halves by the diagonal that leaves the better worst angle, if both are free. The number is
/// this angle in radians, below 0 if a half is turned over.
std::pair<QuadHalves, double> halves_of(const std::array<Vec3, 4>& corners, bool first_is_free = true,
                                        bool second_is_free = true);

/// Faces end at lines, edges of one element or of more than two, edges between regions and edges sharper than
/// the feature angle (degrees). All nodes there stay, and so does each named point. Throws InputError, naming
/// places, for surfaces with one side only, and for meshes that are not conforming. These have hanging nodes,
/// or elements that are there twice, have a corner twice or no area. Quads that are inverted, folded or
/// without area are repaired first, by moving nodes that need not stay over the other elements.
GivenSurface make_given_surface(const GivenMesh& given, double feature_angle);

/// Returns the surface of a mesh in a plane of constant z, whose elements then run counterclockwise, piece by
/// piece. No edge is sharp, and elements may be inverted, folded or flat. `given` loses the lines and points
/// that no element has. Throws InputError as make_given_surface(), and for edges of more than two elements,
/// but not for hanging nodes.
GivenSurface make_flat_surface(GivenMesh& given);

/// Returns the points of a mesh with its lines, and all names.
Mesh lines_of(const Mesh& mesh);

/// Adds the elements of these fine triangles to a patch, whose `point` each vertex of `triangles` is.
void add_elements(const GivenSurface& surface, std::span<const int> fine_triangles,
                  std::span<const std::array<int, 3>> triangles, std::span<const int> point,
                  QuadPatch& patch);

/// Returns the elements of a patch, with points of its boundary first. `inside` gets the places in space of
/// the other points.
QuadPatch elements_within(const GivenSurface& surface, const SurfacePatch& patch, std::vector<Vec3>& inside);

/// Returns the domain of a model whose curves keep all their points as nodes. No stage moves a node that is
/// on no cut. The k-th point of a patch's boundary is the vertex of its map at which the k-th side of its
/// outline begins. Warnings name patches with an odd boundary.
SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size);

}  // namespace delquad
