#pragma once

#include <span>

#include "base/marks.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// Below this eta an element is poor: moves for the valences may not add to the penalty around, and any move
/// that takes from it is welcome.
inline constexpr double kPoorEta = 0.3;
/// A corner whose sine is at most this is flat, reflex or turned over: eta 0.
inline constexpr double kFlatSine = 1e-7;

/// How bad the shapes of a part of a mesh are, for comparison before and after an edit.
class ShapePenalty {
 public:
  /// Both outlive this object.
  ShapePenalty(const QuadTopology& mesh, const QuadRelocation& relocation)
      : mesh_(mesh), relocation_(relocation) {}

  /// Of the corners of the elements around the vertices (dead ones are skipped), the sum of (what the sine
  /// lacks, as a part of what is wanted)^3: one flat corner outweighs a handful that are merely poor. To this
  /// comes how their vertices crowd, see QuadRelocation::crowding(), up to 1. Each element of eta 0 counts as
  /// much as any number of others.
  double around(std::span<const int> vertices);
  /// Elements that it has looked at so far.
  long long looks() const { return looks_; }

 private:
  const QuadTopology& mesh_;
  const QuadRelocation& relocation_;
  Marks elements_met_;
  long long looks_ = 0;
};

}  // namespace delquad
