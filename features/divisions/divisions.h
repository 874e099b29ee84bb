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

/// Returns for each piece of a curve the places of its nodes, as CurveNode::s, ascending, both ends included;
/// empty where no division names its curve. Throws InputError as divide_pieces().
std::vector<std::vector<double>> divide_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                                               const std::vector<CurveDivision>& divisions);

/// Asks for these numbers of edges, and for as many of the curves that face a divided one. Throws InputError
/// as divide_chains(), and for curves that get the nodes of others.
void divide_curves(const Mesh& fine, const SurfaceCurves& curves, const std::vector<CurveDivision>& divisions,
                   CurveDemands& wanted);

/// Refuses numbers that are given and leave a patch with an odd boundary, in an InputError that begins with
/// `prefix`.
void check_divisions_even(const std::string& prefix, const Mesh& fine, const SurfaceCurves& curves,
                          const CurveDemands& wanted, const std::vector<int>& odd_patches);

/// Tells of divided curves that lost nodes to caps: those near the tip of a cone.
void warn_of_lost_nodes(const Mesh& fine, const SurfaceCurves& curves, const CurveDemands& wanted,
                        const std::vector<CurveDivision>& divisions, SurfaceDomain& domain);

/// Returns the size, and near divided curves the lengths of their edges, larger ones too. `domain`: of the
/// model, as it is divided.
std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const PlanarModel& model,
                                            const PlanarDomain& domain,
                                            const std::vector<CurveDivision>& divisions);
std::shared_ptr<const SizeField> as_divided(std::shared_ptr<const SizeField> size, const SurfaceModel& model,
                                            const std::vector<CurveDivision>& divisions);

/// Returns the nodes of a curve that is cut into pieces of these lengths. For each piece these are the
/// lengths from its beginning to its nodes, ascending, both ends included. Ends of pieces are nodes already,
/// and count as the nearest of the wanted ones. Throws InputError for fewer edges than pieces; `label` is the
/// curve's.
std::vector<std::vector<double>> division_places(const CurveDivision& division,
                                                 const std::vector<double>& lengths,
                                                 const std::string& label);

}  // namespace delquad
