#pragma once

#include <span>
#include <string>
#include <vector>

#include "fields/size_field.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"
#include "mesh/places.h"

namespace delquad {

/// How the elements of a mesh, or the triangles of a model, hang together.
struct Topology {
  int euler_characteristic = 0;  ///< vertices - edges + elements
  int free_edges = 0;            ///< in one element
  int branching_edges = 0;       ///< in more than two
  int disagreeing_edges = 0;     ///< in two that run along it the same way: their normals disagree
  bool watertight() const { return free_edges == 0; }
};
Topology topology_of(const Mesh& mesh);

/// By curve (index), whether more than two faces of a model meet there, or two that are turned against each
/// other.
std::vector<char> irregular_curves(const Mesh& fine);

/// Distances up to this many sizes are explained by the size at the place: edges of length h sag by h^2 / 8R,
/// at most h / 4, on a radius of curvature R >= h / 2, and a feature that is narrower than h is missed by
/// about h. Of some 90 meshes of CAD and scans, at sizes from a tenth to a sixtieth of the diagonal, none was
/// further off than 1.01.
inline constexpr double kExplainedSizes = 1.25;

/// Distances at some samples, in diagonals of the model.
struct Distances {
  int samples = 0;
  double max = 0, mean = 0;
  double max_in_sizes = 0;  ///< of the size at the sample; 0 where no size was given
  Places unexplained;       ///< above kExplainedSizes
  void add(double distance);
  /// `size`: delta at the place, in the unit of the distance; infinite: not known.
  void add(double distance, double size, const Place& place);
};

/// How far the maps of all patches are from conformal ones, see FlatQuality.
struct MapReport {
  int patches = 0;
  double sigma_mean = 1;                               ///< by area over all patches
  double sigma_95 = 1, sigma_max = 1, area_ratio = 1;  ///< the worst patch's
  int worst_face = -1;  ///< index of the face of the patch with the worst sigma_95
};

/// How a mesh fits the surface that it was made for.
struct SurfaceReport {
  Topology model, mesh;
  /// Edges that are not in as many elements as they should: two inside a face, and on a curve as many as the
  /// model has faces there.
  Places nonconforming_edges;
  /// Elements whose normal points to the other side than all of their face nearby.
  Places turned_elements;
  Distances nodes_in_faces;    ///< to the face
  Distances nodes_on_curves;   ///< to the nearest of the curve and the faces around
  Distances nodes_at_corners;  ///< the same
  Distances mesh_to_surface, surface_to_mesh;
};

MapReport report_maps(std::span<const FlatPatch* const> maps);

/// Compares a mesh with its model; the mesh has the model's curves and regions.
///
/// mesh_to_surface is sampled at the centre of each element and the middle of each edge, against the true
/// surface (the curve, for edges on curves), or against the triangles of a triangulated model.
/// surface_to_mesh is sampled at the points of the fine triangulation, which lie on the surface, and inside
/// triangles so large that only plane faces have them, a 50th of the diagonal apart; against the elements, a
/// quad being four triangles around its centre. `cuts`: curves that
/// flatten() added, which belong to no true curve. `left_out`: faces, by index, that were not meshed; they do
/// not count. `size`: delta, that distances are compared with; may be null. Points must be finite.
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             const SizeField* size = nullptr);

}  // namespace delquad
