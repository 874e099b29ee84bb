// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/patches/surface_curves.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/planar/curve_pieces.h"

// This header gives curves the numbers of edges that a problem asks for. Curves and symmetry use it.

namespace delquad {

/// Gives the curves of each division their nodes. Throws InputError for names that no curve has, for too few
/// edges, and for curves that are divided twice.
void divide_pieces(const PlanarModel& model, const std::vector<CurveDivision>& divisions,
                   std::vector<CurvePiece>& pieces);

/// Returns for each piece of a curve the places of its nodes, as CurveNode::s, ascending, both ends included.
/// They are empty if no division names the curve. Throws InputError as divide_pieces().
std::vector<std::vector<double>> divide_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                                               const std::vector<CurveDivision>& divisions);

/// Demands these numbers of edges, and equal numbers for curves that face a divided one. Throws InputError as
/// divide_chains(), and for curves that get the nodes of others.
void divide_curves(const Mesh& fine, const SurfaceCurves& curves, const std::vector<CurveDivision>& divisions,
                   CurveDemands& wanted);

/// Throws InputError, beginning with `prefix`, if given numbers leave a patch with an odd boundary.
void check_divisions_even(const std::string& prefix, const Mesh& fine, const SurfaceCurves& curves,
                          const CurveDemands& wanted, const std::vector<int>& odd_patches);

/// Warns of divided curves that lost nodes to caps, near the tip of a cone.
void warn_of_lost_nodes(const Mesh& fine, const SurfaceCurves& curves, const CurveDemands& wanted,
                        const std::vector<CurveDivision>& divisions, SurfaceDomain& domain);

/// Returns the size; near divided curves it is the length of their edges, also if that is larger. `domain`
/// belongs to the model with its divisions.
std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const PlanarModel& model,
                                            const PlanarDomain& domain,
                                            const std::vector<CurveDivision>& divisions);
std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const SurfaceModel& model,
                                            const std::vector<CurveDivision>& divisions);

/// Returns the nodes of a curve that is cut into pieces of these lengths. For each piece it has the lengths
/// from its beginning to its nodes, ascending, both ends included. Ends of pieces are nodes already, and
/// replace the nearest wanted ones. Throws InputError, with the `label` of the curve, for fewer edges than
/// pieces.
std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label);

}  // namespace delquad
