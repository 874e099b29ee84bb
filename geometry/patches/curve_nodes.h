// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "base/matching/edge_counts.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header places nodes on curves of surfaces. Patches and symmetry use it.

namespace delquad {

/// A piece of a curve between two corners, as a polyline of fine points from end to end. A closed curve with
/// one corner at most is one piece, which ends where it begins.
struct CurveChain {
  int curve = -1;  ///< index into Mesh::curves
  std::vector<int> points;
  bool closed() const { return points.front() == points.back(); }
};

/// Returns the pieces of all curves, in the curves' order. Throws InputError if the lines of a curve do not
/// form one chain.
std::vector<CurveChain> curve_chains(const SurfaceModel& model);

/// Wanted and necessary numbers of edges of a curve.
struct CurveDemand {
  double integral = 0;       ///< integral of ds/delta along it: the wanted number
  int minimum = 1;           ///< least number of edges
  std::vector<int> patches;  ///< patches at the curve; a seam has its patch twice
  int exact = 0;             ///< given number of edges; 0: free
  int most = kAnyNumber;     ///< most edges that are no shorter than QuadLimits allow
};

/// Returns the largest number >= 1 of edges at least `shortest` long on a curve of this length, both in
/// sizes. If `shortest` is 0, any number is allowed.
inline int most_edges(double length, double shortest) {
  return shortest > 0 ? std::max(1, static_cast<int>(std::min(length / shortest, 1e9))) : kAnyNumber;
}

/// A piece of a curve whose nodes are images of the nodes of another.
struct ChainPair {
  int chain, master;
  bool forward;  ///< whether both have the same direction
  Motion motion;
};

/// Returns demands by which both curves of a pair get the same number of edges: the master counts for the
/// patches of both.
std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs);

/// A node on a curve, at `s` in [0, number of lines]: the index of the fine line plus the fraction along it.
struct CurveNode {
  double s;
  int node;  ///< in SurfaceNodes::points
};

struct SurfaceNodes {
  std::vector<Vec3> points;
  std::vector<std::vector<CurveNode>> on_curve;  ///< nodes of each curve, ascending in s, both ends included
};

/// Integral of ds/delta along a curve, tabulated from its beginning to its end.
struct SizeIntegral {
  struct Entry {
    double s;         ///< as in CurveNode
    double integral;  ///< from the beginning to s
  };
  std::vector<Entry> entries;
  double total() const { return entries.back().integral; }
  /// Convert a part, 0 to 1, of the total integral to a place and back.
  double s_at(double part) const { return interpolated(part * total(), &Entry::integral, &Entry::s); }
  double part_at(double s) const { return interpolated(s, &Entry::s, &Entry::integral) / total(); }

 private:
  double interpolated(double at, double Entry::*from, double Entry::*to) const;
};

/// Returns the size at x = (1 - t) a + t b, for neighboring fine points a and b of a curve.
using SizeOnLine = std::function<double(int a, int b, double t, const Vec3& x, int& hint)>;

/// Returns the integral by two-point Gauss rules on pieces of fine lines up to a fourth of the size. `limits`
/// (if any) has the largest size at each point of the chain, linear between them.
SizeIntegral size_integral(const Mesh& fine, const CurveChain& chain, const SizeOnLine& size,
                           std::span<const double> limits = {});

/// Places of nodes along each curve, ascending, both ends included, in edges of equal integral from its
/// beginning.
using CurvePlaces = std::vector<std::vector<double>>;
/// Returns the places 0, 1, 2 ... for these numbers of edges.
CurvePlaces equal_places(const std::vector<int>& counts);

/// Returns nodes at these places, projected to the curves, or to the faces of cuts. `cut_face` has the face
/// of each curve that is a cut; else -1. Common ends of curves share their node.
SurfaceNodes place_nodes(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                         const std::vector<int>& cut_face, const std::vector<SizeIntegral>& integrals,
                         const CurvePlaces& places);

/// Returns the point of the fine lines at `s`, as in CurveNode.
Vec3 fine_point_at(const Mesh& fine, const CurveChain& chain, double s);

/// Returns the place in space of a node at `s`, projected as by place_nodes().
Vec3 place_on_curve(const SurfaceModel& model, const CurveChain& chain, const std::vector<int>& cut_face,
                    double s);

}  // namespace delquad
