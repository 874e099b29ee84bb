#pragma once

#include <limits>
#include <vector>

#include "base/budget.h"
#include "smoothing/surface/surface_tracks.h"

namespace delquad {

/// Quads with a corner in this ball are lifted.
struct LiftedBall {
  Vec3 centre = {};
  double radius = std::numeric_limits<double>::infinity();
};

/// Lifts the worst quads of a surface in space: while quads below `eta` improve, their vertices slide over
/// the true faces and along the curves to where the worst quad around the vertex is best, also where that is
/// outside the parameter plane's fine triangles, as happens where a face is narrower than these are exact. No
/// least eta around a vertex gets lower; no edge at a node on a curve falls below half of the shortest that
/// was around it. `places` are those of the tracks' vertices, and are updated. Each place that is tried for a
/// vertex is one of the `trials`, on CAD ten; once these are spent, the rest stays. Returns how many vertices
/// moved.
int lift_worst_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, int max_sweeps,
                          Budget& trials, const LiftedBall& ball = {});

/// The same for quads beyond what is asked for, see is_beyond_asked(), or warped more than kAskedWarp, sides
/// over `size`: vertices of such a quad move where fewer quads fail by that, for not too much of eta. No eta
/// falls below kAskedEta, nor below the worst of all, and where it was below it does not fall.
int mend_failing_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, const SizeField& size,
                            int max_sweeps, Budget& trials);

}  // namespace delquad
