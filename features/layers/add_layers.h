// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/model.h"
#include "features/layers/layer_walls.h"
#include "features/sizes/fine_spots.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/planar_model.h"

// This header puts boundary layers into a domain. The pipeline, features and measures use it.

namespace delquad {

/// The size of finished layers.
struct LayerCount {
  int columns = 0;         ///< edges of curves with quads on them
  int quads = 0;           ///< all
  int fans = 0;            ///< quads at corners of fans, in the first layer
  double least_scale = 1;  ///< of heights; below 1 where there is no room for them
};

template <>
struct Counters<LayerCount> {
  using S = LayerCount;
  static constexpr const char* step = "layers";
  static constexpr auto all = std::tuple{counter("columns", &S::columns), counter("quads", &S::quads),
                                         counter("fans", &S::fans), counter("least_scale", &S::least_scale)};
};

struct LayerReport {
  LayerCount count;
  std::string least_at;  ///< where heights are scaled the most
  /// Most length of an edge of a front by the height of its last layer, where that is as it was asked for.
  double largest_jump = 1;
  std::string jump_on;  ///< the curve where that is so
  /// The curve where heights are scaled the most.
  std::string least_on;
  std::vector<int> patches;      ///< those that changed
  std::vector<WallNodes> walls;  ///< of a surface
};

/// Adds quads to domain.boundary, along the curves that the layers name. It takes the covered parts from the
/// patches, so that the edges of the last layers become their boundary. The patches as they were are in
/// domain.outlines. Nodes of curves on which layers end are placed anew, in all patches that have them and on
/// periodic curves. If there are such, patches get even numbers of edges. Mirror images of patches get the
/// layers of their masters. Throws InputError for layers that cannot be, and for more than `max_quads`.
LayerReport add_layers(PlanarDomain& domain, std::span<const LayerSpec> specs, double max_quads);

/// Returns spots at corners with fans whose edges are too long. Quads there would have more than 50 times the
/// area of the fan's quads beside them. Solvers see that jump.
std::vector<LocalSize> fan_spots(const PlanarDomain& domain, std::span<const LayerSpec> specs);

/// Puts the layers of a problem into its domain, and makes the background mesh of the rest in the plane.
/// Warnings tell where layers had to be lower, and where the rest of the mesh is far coarser than they are.
/// Returns the edges that are much shorter than the size, beside which it is to become less.
std::vector<LocalSize> put_layers(const MeshProblem& problem, PlanarDomain& domain, MeshingSetup& p);

/// Puts the layers of a problem into the patches of a surface. Returns the same. The nodes of curves that
/// have layers, or on which these end, stay.
std::vector<LocalSize> put_layers(const MeshProblem& problem, const SurfaceModel& model,
                                  SurfaceDomain& domain, MeshingSetup& p);

/// Returns which curves of a fine triangulation have layers. Throws InputError for names that no curve has.
std::vector<char> layered_curves(const Mesh& fine, std::span<const LayerSpec> specs);

/// Returns which quads of a mesh are of layers: in each region the first ones.
std::vector<char> quads_in_layers(const MeshingSetup& prepared, const Mesh& mesh);

}  // namespace delquad
