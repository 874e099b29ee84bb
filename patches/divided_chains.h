#pragma once

#include <string>
#include <vector>

#include "patches/curve_nodes.h"

namespace delquad {

/// Of each piece of a curve the places of its nodes, as CurveNode::s, ascending, both ends included; empty
/// where no division names its curve. Throws InputError for names that no curve has, for too few edges, and
/// for curves that are divided twice.
std::vector<std::vector<double>> divide_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                                               const std::vector<CurveDivision>& divisions);

/// The point of the fine lines at `s`.
Vec3 fine_point_at(const Mesh& fine, const CurveChain& chain, double s);

}  // namespace delquad
