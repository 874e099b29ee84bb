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

/// Returns the pieces of all curves, in the curves' order. Throws InputError where the lines of a curve do
/// not form one chain.
std::vector<CurveChain> curve_chains(const SurfaceModel& model);

/// How many edges a curve wants and must have.
struct CurveDemand {
  double integral = 0;  ///< of ds/delta along it
  int minimum = 1;
  std::vector<int> patches;  ///< that it bounds; a seam names its patch twice
  int exact = 0;             ///< where their number is given; 0: it is free
  int most = kAnyNumber;     ///< with more, edges are shorter than the limits, see QuadLimits
};

/// Returns the most edges that are at least `shortest` long on a curve of this length, at least 1; both in
/// sizes, 0: any.
inline int most_edges(double length, double shortest) {
  return shortest > 0 ? std::max(1, static_cast<int>(std::min(length / shortest, 1e9))) : kAnyNumber;
}

/// A piece of a curve that gets the images of the nodes of another.
struct ChainPair {
  int chain, master;
  bool forward;  ///< both run the same way
  Motion motion;
};

/// Returns how the curves are to be meshed so that each pair has as many edges: what bounds the one bounds
/// the other.
std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs);

/// A node on a curve: at `s` in [0, number of lines], the fine line's index plus the fraction along it.
struct CurveNode {
  double s;
  int node;  ///< in SurfaceNodes::points
};

struct SurfaceNodes {
  std::vector<Vec3> points;
  std::vector<std::vector<CurveNode>> on_curve;  ///< of each curve, ascending in s, both ends included
};

/// Integral of ds/delta along a curve, tabulated from its beginning to its end.
struct SizeIntegral {
  struct Entry {
    double s;         ///< as in CurveNode
    double integral;  ///< from the beginning to s
  };
  std::vector<Entry> entries;
  double total() const { return entries.back().integral; }
  /// Returns the place where the integral reaches this part of the total, and the other way round.
  double s_at(double part) const { return interpolated(part * total(), &Entry::integral, &Entry::s); }
  double part_at(double s) const { return interpolated(s, &Entry::s, &Entry::integral) / total(); }

 private:
  double interpolated(double at, double Entry::*from, double Entry::*to) const;
};

/// The size at x = (1 - t) a + t b of two fine points that are neighbors on a curve.
using SizeOnLine = std::function<double(int a, int b, double t, const Vec3& x, int& hint)>;

/// Integrates by two-point Gauss on pieces of the fine lines that are short against the size. `limits` (if
/// any): what the size may be at most at each point of the chain, linear between them.
SizeIntegral size_integral(const Mesh& fine, const CurveChain& chain, const SizeOnLine& size,
                           std::span<const double> limits = {});

/// Places along each curve, ascending, both ends included, in edges from its beginning: the k-th is k where
/// all edges are of equal integral.
using CurvePlaces = std::vector<std::vector<double>>;
CurvePlaces equal_places(const std::vector<int>& counts);

/// Places nodes and projects them to the curves, or to the faces that cuts run through. `cut_face`: for each
/// curve, -1 where it is no cut. Ends of curves that meet share their node.
SurfaceNodes place_nodes(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                         const std::vector<int>& cut_face, const std::vector<SizeIntegral>& integrals,
                         const CurvePlaces& places);

/// Returns the point of the fine lines at `s`, as in CurveNode.
Vec3 fine_point_at(const Mesh& fine, const CurveChain& chain, double s);

/// Returns the place in space of a node there.
Vec3 place_on_curve(const SurfaceModel& model, const CurveChain& chain, const std::vector<int>& cut_face,
                    double s);

}  // namespace delquad
