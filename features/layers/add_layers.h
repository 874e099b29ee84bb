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

struct CutSurface;
struct SymmetricHalf;

/// Extent of finished layers.
struct LayerCount {
  int columns = 0;         ///< edges of curves with quads on them
  int quads = 0;           ///< number of quads in all layers
  int fans = 0;            ///< quads at corners of fans, in the first layer
  double least_scale = 1;  ///< least factor of heights; below 1 if there is no room for them
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
  std::string least_at;  ///< place where heights are scaled the most
  /// Largest ratio of the length of a front edge to the height of its last layer, if that height is the
  /// requested one.
  double largest_jump = 1;
  std::string jump_on;  ///< curve and place of this ratio
  /// The curve where heights are scaled the most.
  std::string least_on;
  std::vector<int> patches;      ///< changed patches
  std::vector<WallNodes> walls;  ///< of a surface
};

/// Adds quads to domain.boundary along the curves of the layers. It takes their area from the patches, so
/// that the edges of the last layers become patch boundaries. domain.outlines gets the former patches. Nodes
/// of curves on which layers end are placed again, in all patches and on periodic curves; patches then get
/// even numbers of edges. Throws InputError, with curve and place, for impossible layers and for more than
/// `max_quads`. Own method.
LayerReport add_layers(PlanarDomain& domain, std::span<const LayerSpec> specs, double max_quads);

/// Returns spots at corners with fans whose edges are too long. Quads there would have more than 50 times the
/// area of the fan's quads beside them. Solvers see that jump.
std::vector<LocalSize> fan_spots(const PlanarDomain& domain, std::span<const LayerSpec> specs);

/// Puts layers into a domain, and makes the background mesh of the rest in the plane.
/// Warnings tell where layers had to be lower, and where the rest of the mesh is far coarser. Returns the
/// edges that are much shorter than the size, beside which sizes must shrink.
std::vector<LocalSize> put_layers(std::span<const LayerSpec> layers, const MappedSpec& grids,
                                  PlanarDomain& domain, MeshingSetup& p);

/// Does the same for the patches of a surface. The nodes of curves that have layers, or on which layers end,
/// stay. `part`: the model is this part of a symmetric one; null: it is the whole.
std::vector<LocalSize> put_layers(std::span<const LayerSpec> layers, const MappedSpec& grids,
                                  const SurfaceModel& model, const SymmetricHalf* part, SurfaceDomain& domain,
                                  MeshingSetup& p);

/// Returns layers of the part of a symmetric surface, on curves by their numbers there. Throws InputError if
/// an image has not the same layer, and as layered_curves().
std::vector<LayerSpec> layers_of_part(std::span<const LayerSpec> layers, const CutSurface& surface);

/// Returns for each curve of a fine triangulation whether it has layers. Throws InputError for names that no
/// curve has.
std::vector<char> layered_curves(const Mesh& fine, std::span<const LayerSpec> specs);

/// Returns for each quad whether it belongs to layers, or to their mirror images: these are the first quads
/// of each region.
std::vector<char> quads_in_layers(const MeshingSetup& prepared, const Mesh& mesh);

}  // namespace delquad
