// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "geometry/patches/meshing_setup.h"
#include "metrics/judgement/criteria.h"

// This header finds elements beyond limits and explains them. All judges of elements use it.

namespace delquad {

/// A mesh to judge.
struct JudgedMesh {
  const Mesh& mesh;
  const ElementSides& sides;
  const SizeField* size;              ///< unit of relative lengths
  const MeshingSetup* prepared = {};  ///< problem of the mesh; null: another program made it
  std::vector<char> on_purpose = {};  ///< by quad: its sides and aspect are requested; empty: none
  double size_at(std::span<const int> element, int& hint) const;
};

/// Cause of a failing element.
enum FailingCause {
  kAtCorner,
  kAtFineCurve,
  kAtGap,
  kAtSharpEdge,
  kAtBend,
  kAtFineSize,
  kAtNumber,
  kAtIrregular,
  kOtherwise,
  kFailingCauses
};
inline constexpr const char* kCauseNames[] = {"corner",          "short curve",      "narrow gap",
                                              "sharp edge",      "curvature",        "reduced size",
                                              "number of edges", "irregular vertex", "choice"};

/// A failing element with its cause, if known.
struct FailingElement {
  int element, cause_at;  ///< triangles first, then quads; `cause_at` is the element at the cause
  std::uint64_t beyond;   ///< bit k: limit k
  double badness;         ///< factor by which it exceeds its limit
  double size;            ///< wanted size there; NaN if its sides are requested
  FailingCause cause = kOtherwise;
  double what = 0;              ///< angle of the corner in radians, a length, or a number of edges
  std::array<int, 2> curves{};  ///< curves at the corner, or the curve
  double ignored_below = 0;     ///< on surfaces: length below which the cause can be ignored; 0: unknown
};

/// Result of the elements for a limit.
struct LimitTally {
  double worst = std::numeric_limits<double>::quiet_NaN();  ///< in parts of the size if the limit is
  int worst_element = -1;                                   ///< -1: the limit applies to no element
  Places places = {};                                       ///< places of failing elements
  std::vector<int> failing = {};
};

/// Elements beyond limits and their causes. It makes every judgement of single elements.
class FailingElements {
 public:
  /// Judges all elements. Both arguments must outlive it. There are at most kMostLimits limits. Triangles
  /// count `with_triangles`.
  FailingElements(const JudgedMesh& mesh, const Criteria& asked, bool with_triangles);

  /// Finds the causes.
  void explain();
  /// Returns a description of the elements with a cause, with a remedy, after explain(): "12 where curves are
  /// finer than the size, ...". `named` tells curves, `advised` the remedy for a surface. Empty: there are
  /// none.
  std::string text_of(FailingCause cause, bool named, bool advised = true) const;
  /// Returns changes that may cure elements with a cause, after explain(). The first is to leave parts of the
  /// model out, the next a finer size that the least length allows.
  std::vector<Cure> cures_of(FailingCause cause) const;
  /// Returns a description of limit k: "3 elements have an angle below 20 degrees, the least 9.5: at ...";
  /// empty: it is kept.
  std::string text_of(std::size_t limit) const;
  Place place_of(int element) const;
  /// Returns whether sides and aspect of a quad are requested.
  bool is_on_purpose(int element) const;
  int n_triangles() const { return static_cast<int>(judged.mesh.triangles.size()); }

  const JudgedMesh& judged;
  const Criteria& criteria;
  std::vector<FailingElement> elements = {};  ///< worst first
  std::vector<LimitTally> tallies;            ///< by limit

 private:
  struct Limits;
  template <std::size_t N>
  void judge(int element, const std::array<int, N>& v, const Limits& limits, int& hint);
};

}  // namespace delquad
