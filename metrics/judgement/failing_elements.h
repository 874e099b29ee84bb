#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "metrics/judgement/criteria.h"
#include "patches/prepared.h"

namespace delquad {

/// A mesh that is judged.
struct JudgedMesh {
  const Mesh& mesh;
  const ElementSides& sides;
  const SizeField* size;                 ///< that lengths are parts of
  const PreparedProblem* prepared = {};  ///< what it was made of; null: others made it
  std::vector<char> on_purpose = {};  ///< by quad: sides and aspects are as they are asked for; empty: none
  double size_at(std::span<const int> element, int& hint) const;
};

/// Why an element is beyond a limit.
enum FailingCause { kAtCorner, kAtFineCurve, kAtGap, kAtSharpEdge, kOtherwise, kFailingCauses };
inline constexpr const char* kCauseNames[] = {"corner", "short curve", "narrow gap", "sharp edge", "choice"};

/// Why it is, as far as that is known.
struct FailingElement {
  int element, cause_at;  ///< triangles first, then quads; `cause_at`: that at which its cause is
  std::uint64_t beyond;   ///< bit k: limit k
  double badness;         ///< how many times beyond its limit
  double size;            ///< wanted there; not a number where sides are as they are on purpose
  FailingCause cause = kOtherwise;
  double what = 0;              ///< radians of the corner, or a length
  std::array<int, 2> curves{};  ///< at a corner or short: their indices
  double ignored_below = 0;  ///< of a surface: a length below which the cause is left out; 0: none is known
};

/// How the elements do by one limit.
struct LimitTally {
  double worst = std::numeric_limits<double>::quiet_NaN();  ///< in parts of the size where the limit is
  int worst_element = -1;                                   ///< -1: it is the limit of none
  Places places = {};                                       ///< of those that fail
  std::vector<int> failing = {};
};

/// Elements beyond limits, and why they are: every judgement of single elements.
class FailingElements {
 public:
  /// Both have to outlive it. At most kMostLimits. Triangles are judged by `with_triangles`.
  FailingElements(const JudgedMesh& mesh, const Criteria& asked, bool with_triangles);

  /// Finds the causes.
  void explain();
  /// Of the elements with that cause, after explain(): "12 where curves are finer than the size, ...", with
  /// what helps. `named`: curves are told. Empty: there are none.
  std::string text_of(FailingCause cause, bool named) const;
  /// Of limit k: "3 elements have an angle below 20 degrees, the least 9.5: at ..."; empty: it is kept.
  std::string text_of(std::size_t limit) const;
  Place place_of(int element) const;
  /// Whether a quad's sides and aspects are as they are on purpose.
  bool is_on_purpose(int element) const;
  int n_triangles() const { return static_cast<int>(judged.mesh.triangles.size()); }

  const JudgedMesh& judged;
  const Criteria& criteria;
  std::vector<FailingElement> elements = {};  ///< the worst first
  std::vector<LimitTally> tallies;            ///< by limit

 private:
  struct Limits;
  template <std::size_t N>
  void judge(int element, const std::array<int, N>& v, const Limits& limits, int& hint);
};

}  // namespace delquad
