#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "algorithms/insertion/linf_geometry.h"
#include "fields/cross_field.h"
#include "mesh/vec.h"

namespace delquad {

/// A front edge: the side of an active triangle that borders a resolved triangle or the boundary.
struct FrontEdge {
  Vec2 p, q;                          ///< the edge; the active triangle lies on its left
  Vec2 apex;                          ///< the active triangle's third vertex
  std::optional<Vec2> resolved_apex;  ///< the resolved triangle's third vertex; none on the boundary
  double delta;                       ///< delta' at the middle of the edge
  Frame frame;                        ///< the cross field's axes there
};

/// A short list of points.
struct Candidates {
  std::array<Vec2, 3> points;
  int count = 0;
  void add(Vec2 x) { points[count++] = x; }
};

/// Where the next point goes, in which norm triangles are measured: the strategy that the comparison
/// exchanges.
class PointPlacement {
 public:
  virtual ~PointPlacement() = default;
  virtual char letter() const = 0;  ///< in pipeline words
  virtual std::string name() const = 0;
  virtual double default_h_max() const = 0;
  /// Size of a triangle over delta' at its centroid: 1 for the strategy's ideal triangle. `cross` is the
  /// field there, not necessarily of unit length.
  virtual double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const = 0;
  /// Where a new point may go over a front edge, best first; the mesher inserts the first that it can.
  virtual Candidates candidates(const FrontEdge& edge) const = 0;
  /// Length of v in the strategy's norm, for the too-close test.
  virtual double length(Vec2 v, const Frame& frame) const = 0;
};

/// F: Rebay's frontal insertion in the L2 norm; ideal triangle equilateral.
std::unique_ptr<PointPlacement> make_l2_frontal();

struct LinfOptions {
  /// Keep the new point out of the resolved triangle's circumsquare (the paper's x_l).
  bool lower_clamp = false;
};
/// D: Delquad insertion in the L-infinity norm of the cross field; ideal triangle half a square.
std::unique_ptr<PointPlacement> make_linf_delquad(const LinfOptions& options = {});

}  // namespace delquad
