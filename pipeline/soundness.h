#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "pipeline/prepare.h"
#include "surfaces/surface_report.h"

namespace delquad {

/// Whether a mesh is one of its model, and fit to be computed with. It is sound when
/// - every coordinate is a finite number;
/// - no quad is inverted or flat (eta 0) and none folded (over 90 degrees along a diagonal), no triangle is
///   without positive area, and no element faces away from its model;
/// - it is conforming: every edge is in as many elements as the model has faces there, two inside of them,
/// and
///   elements side by side run the same way round;
/// - it hangs together as its model does: the same Euler characteristic, watertight where the model is;
/// - none of the model is lost and nothing is added: no place of the one is further from the other than the
///   size there explains, see kExplainedSizes.
/// Triangles that are left among quads do not make a mesh unsound.
struct Soundness {
  /// One for each way in which it is not, with numbers, faces and the first places; empty: it is sound.
  std::vector<std::string> reasons;
  bool sound() const { return reasons.empty(); }
  /// All of them in one line.
  std::string text() const;
};

/// A mesh that was to be written is not sound.
class UnsoundError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

bool has_finite_points(const Mesh& mesh);

/// The first two of these, which are about single elements. Planar domains are seen from above.
Soundness check_elements(const PreparedCase& prepared, const Mesh& mesh);

/// All of them, of a mesh with the curves and regions of its case. `report`: of surfaces, without the faces
/// that were left out; null of a mesh with points that are not finite.
Soundness check_soundness(const PreparedCase& prepared, const Mesh& mesh, const SurfaceReport* report);

}  // namespace delquad
