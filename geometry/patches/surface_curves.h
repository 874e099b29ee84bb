// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "algorithms/fields/surface/surface_size.h"
#include "delquad/fields.h"
#include "geometry/patches/across_view.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/face_corners.h"
#include "geometry/patches/patch_outline.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"

// This header relates the curves of a surface to its patches. Curves, grids and divisions use it.

namespace delquad {

/// A boundary loop of quads needs four edges to enclose an area.
inline constexpr int kFewestLoopEdges = 4;

/// The curves of a flattened model and its patches, as they are before curves get edges.
struct SurfaceCurves {
  std::vector<FlatPatch> maps;
  std::vector<int> cut_face;      ///< face of each curve of the model that is a cut; -1: no cut
  std::vector<char> is_embedded;  ///< whether each curve of the model is embedded
  std::vector<CurveChain> chains;
  std::vector<ChainPair> images;       ///< pairs with an image; each follows the pair of its master
  std::vector<PatchOutline> outlines;  ///< outline of each map
  std::vector<FaceCorner> corners;
  std::vector<std::vector<double>> tube_sizes;  ///< largest sizes at each map's vertices; empty: any
};

/// Returns the curves of a model. Throws InputError as curve_chains(), and FaceError for a curve without
/// length.
SurfaceCurves find_curves(const SurfaceModel& model, Flattening flattening, const SizeField& size);

/// Returns for each chain the chain with its number of edges: its master, or itself.
std::vector<int> leaders(const SurfaceCurves& curves);

/// Wanted and necessary numbers of edges, by chain.
struct CurveDemands {
  std::vector<SizeIntegral> integrals;
  std::vector<double> lengths;  ///< lengths in the requested sizes
  std::vector<int> group;       ///< see group_facing_curves()
  std::vector<CurveDemand> demands;
  std::vector<double> quads;  ///< integral of dA/delta^2 over each patch
  /// For each chain the given places of its nodes, as CurveNode::s, both ends included; empty: it is free.
  std::vector<std::vector<double>> divided = {};
};

/// Returns the size on lines; `size` must outlive it.
SizeOnLine size_on_lines(const SurfaceSize& size);

/// Returns the demands of curves. `asked` is the requested size; `size` may be smaller beside short curves.
CurveDemands measure_curves(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across,
                            const SurfaceSize& size, const SizeField& asked);

/// Returns a warning for each curve shorter than half of the size.
std::vector<Warning> warn_of_short_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                          const CurveDemands& wanted);

/// Returns a mesh of the final nodes, and of lines, curves and regions.
Mesh boundary_mesh(const Mesh& fine, const std::vector<CurveChain>& chains, const SurfaceNodes& nodes);

/// Returns the face of a patch for messages.
std::string face_name(const Mesh& fine, const FlatPatch& map);

/// Calls work(patch) for each patch, in parallel.
void for_each_patch(const Mesh& fine, const std::vector<FlatPatch>& maps,
                    const std::function<void(std::size_t)>& work);

}  // namespace delquad
