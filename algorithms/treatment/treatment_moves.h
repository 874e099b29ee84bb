// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

// This header has edits of quad meshes and their valence energy. The treatment, stage C and repairs use it.

namespace delquad {

/// One edit of the quad mesh.
struct TreatmentMove {
  enum Kind : int {
    kRotateForward,
    kRotateBackward,
    kCollapse,
    kDoublet,
    kInset,
    kSplit,
    kOpenForward,
    kOpenBackward
  };
  Kind kind;
  int at;       ///< half-edge, or the vertex of a doublet
  int to = -1;  ///< second half-edge of a split
  friend auto operator<=>(const TreatmentMove&, const TreatmentMove&) = default;
};

/// Returns the limit of elements that relocation and measures of quality examine, for moves on a patch of n
/// elements. Some hundred for each are usual. At a vertex of n elements the work grows with the cube of n.
constexpr long long most_looks(int n) { return 100'000 + 10'000LL * n; }

/// Vertices that a move touches, at most six.
struct TouchedVertices {
  std::array<int, 6> v;
  int n = 0;
  const int* begin() const { return v.data(); }
  const int* end() const { return v.data() + n; }
};

/// Distance of valences from their ideal: the sum of (valence - ideal)^2. The ideal is 4 inside, and angle /
/// 90 degrees, rounded and at least 1, on the boundary. A valence that forces an element below eta 1/2 costs
/// 1 to 12 more, most at eta 0. Examples are a doublet, or a single quad in a boundary angle above 135
/// degrees. A valence of 6 or 3 forces none.
class ValenceEnergy {
 public:
  explicit ValenceEnergy(const QuadTopology& mesh);

  /// Returns the term of v with this valence, 0 if it is regular.
  int of(int v, int valence) const {
    if (mesh_.on_boundary(v)) return misfit(valence, ideal_[v]);
    return static_cast<std::size_t>(valence) < inside_.size() ? inside_[valence] : misfit(valence, kInside);
  }
  int of(int v) const { return of(v, mesh_.valence(v)); }
  /// Returns the ideal valence.
  int ideal(int v) const { return mesh_.on_boundary(v) ? ideal_[v].valence : kInside.valence; }
  /// Returns the decrease of the sum by a legal move that is no inset.
  int gain(const TreatmentMove& move) const;

 private:
  struct Ideal {
    double angle;  ///< of the elements around the vertex, in right angles
    int valence;
  };
  static constexpr Ideal kInside{4, 4};
  static int misfit(int valence, const Ideal& ideal);
  int change(int v, int by) const {
    const int valence = mesh_.valence(v);
    if (!mesh_.on_boundary(v) && static_cast<std::size_t>(valence) + 1 < inside_.size() && valence + by >= 0)
      return inside_[valence] - inside_[valence + by];
    return of(v) - of(v, valence + by);
  }

  const QuadTopology& mesh_;
  std::vector<Ideal> ideal_;    ///< of boundary vertices
  std::array<int, 16> inside_;  ///< of interior vertices, by valence
};

/// Returns whether a ring around these quads would divide a sharp corner of the boundary that one of them
/// fills.
bool ring_divides_sharp_corner(const QuadTopology& mesh, std::span<const int> quads);

/// Returns whether a move keeps the mesh conforming and disturbs no held vertex.
bool is_legal(const QuadTopology& mesh, const TreatmentMove& move);
/// Applies a legal move; new vertices lie at or near old ones.
void apply(QuadTopology& mesh, const TreatmentMove& move);
/// Does the same, and adds new vertices to the relocation and to `touched`.
void apply(QuadTopology& mesh, QuadRelocation& relocation, const TreatmentMove& move,
           std::vector<int>& touched);
/// Returns the vertices whose valence or elements the move changes, without removed and new ones.
TouchedVertices touched_by(const QuadTopology& mesh, const TreatmentMove& move);

/// Calls f(move) for rotations of the sides of an element, its two collapses and its doublets. Only rotations
/// are checked: their sides lie between quads.
template <class F>
void for_each_move(const QuadTopology& mesh, int element, F&& f) {
  if (!mesh.alive(element)) return;
  const int n = mesh.is_quad(element) ? 4 : 3;
  for (int h = 4 * element; h < 4 * element + n; ++h) {
    const int v = mesh.origin(h);
    if (mesh.valence(v) == 2 && !mesh.on_boundary(v)) f(TreatmentMove{TreatmentMove::kDoublet, v});
    if (n == 3) continue;
    if (const int t = mesh.twin(h); t >= 0 && mesh.is_quad(QuadTopology::element(t))) {
      f(TreatmentMove{TreatmentMove::kRotateForward, t < h ? t : h});
      f(TreatmentMove{TreatmentMove::kRotateBackward, t < h ? t : h});
    }
    // The removed corner is interior; if both are, the first one is kept.
    const int opposite = mesh.next(mesh.next(h));
    const bool goes = !mesh.on_boundary(mesh.origin(opposite));
    if (goes && (mesh.on_boundary(v) || h < opposite)) f(TreatmentMove{TreatmentMove::kCollapse, h});
  }
}

/// Calls f(move) for openings of the sides of an element that give one of its boundary vertices one more
/// edge. They are not checked. Unlike rotations they take no edge from the next boundary vertex.
template <class F>
void for_each_opening(const QuadTopology& mesh, int element, F&& f) {
  if (!mesh.is_quad(element)) return;
  for (int h = 4 * element; h < 4 * element + 4; ++h) {
    if (mesh.twin(h) < 0) continue;
    if (mesh.on_boundary(mesh.target(mesh.next(h)))) f(TreatmentMove{TreatmentMove::kOpenForward, h});
    if (mesh.on_boundary(mesh.origin(mesh.prev(h)))) f(TreatmentMove{TreatmentMove::kOpenBackward, h});
  }
}

/// Calls f(move) for splits of a vertex. They are not checked, but both parts keep at least valence 3.
/// Vertices with very many edges are only split in halves. The treatment has no splits.
template <class F>
void for_each_split(const QuadTopology& mesh, int v, F&& f) {
  constexpr int kMany = 32;
  const int valence = mesh.valence(v), half = valence > kMany ? valence / 2 : 0;
  if (valence < 4) return;
  for (int from = mesh.out(v), n = 0; n < mesh.valence(v) - 1; ++n, from = mesh.around(from)) {
    int to = mesh.around(from);
    for (int m = n + 2; m < mesh.valence(v); ++m) {
      to = mesh.around(to);
      const bool whole = !mesh.on_boundary(v) && n + mesh.valence(v) - m < 2;
      if (!whole && (half == 0 || m - n == half)) f(TreatmentMove{TreatmentMove::kSplit, from, to});
    }
  }
}

/// A move with its decrease of valence energy.
struct Candidate {
  int gain;
  TreatmentMove move;
  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : other.move < move;
  }
};

/// Queue of moves that lower the valence energy, largest gain first.
class MoveQueue {
 public:
  /// Both must outlive this object.
  MoveQueue(const QuadTopology& mesh, const ValenceEnergy& energy) : mesh_(mesh), energy_(energy) {}

  void push(const Candidate& candidate) { queue_.push(candidate); }
  /// Removes and returns the best move that is legal now, with its current gain; nothing if none is left.
  std::optional<TreatmentMove> pop();

 private:
  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  std::priority_queue<Candidate> queue_;
  Candidate last_{0, {}};  ///< last removed move; gain 0: none since the queue was empty
};

}  // namespace delquad
