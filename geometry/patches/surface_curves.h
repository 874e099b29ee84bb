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

/// The curves of a flattened model and how they bound its patches: all that stays while they get their edges.
struct SurfaceCurves {
  std::vector<FlatPatch> maps;
  std::vector<int> cut_face;  ///< of each curve of the model: the face that this cut runs through; -1: no cut
  std::vector<char> is_embedded;  ///< of each curve of the model
  std::vector<CurveChain> chains;
  std::vector<ChainPair> images;       ///< each once, behind the pair that its master is the image of
  std::vector<PatchOutline> outlines;  ///< of each map
  std::vector<FaceCorner> corners;
  std::vector<std::vector<double>> tube_sizes;  ///< at the vertices of each map
};

SurfaceCurves find_curves(const SurfaceModel& model, Flattening flattening, const SizeField& size);

/// Returns for each chain the one whose number of edges it has: its master, or itself.
std::vector<int> leaders(const SurfaceCurves& curves);

/// How many edges curves want and must have, by chain.
struct CurveDemands {
  std::vector<SizeIntegral> integrals;
  std::vector<double> lengths;  ///< in sizes as asked
  std::vector<int> group;       ///< those that face each other along strips, see group_facing_curves()
  std::vector<CurveDemand> demands;
  std::vector<double> quads;  ///< of each patch: the integral of dA/delta^2
  /// For each chain the places that its nodes were given, as CurveNode::s, both ends included; empty: it is
  /// free.
  std::vector<std::vector<double>> divided = {};
};

/// Makes the size on lines; `size` outlives it.
SizeOnLine size_on_lines(const SurfaceSize& size);

/// Measures the curves. `asked`: the size as the user wants it, of which `size` may be less beside short
/// curves.
CurveDemands measure_curves(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across,
                            const SurfaceSize& size, const SizeField& asked);

/// Returns a warning for each curve that is much shorter than the size.
std::vector<Warning> warn_of_short_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                          const CurveDemands& wanted);

/// Returns a mesh of the nodes, lines, curves and regions, once the nodes are those that remain.
Mesh boundary_mesh(const Mesh& fine, const std::vector<CurveChain>& chains, const SurfaceNodes& nodes);

std::string face_name(const Mesh& fine, const FlatPatch& map);

/// Calls work(patch), in parallel.
void for_each_patch(const Mesh& fine, const std::vector<FlatPatch>& maps,
                    const std::function<void(std::size_t)>& work);

}  // namespace delquad
