// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/treatment/treatment_moves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/cancel.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Cost of a valence that forces an element of eta 0, relative to single steps of valence.
constexpr double kForcedBad = 12;

/// Returns the cost of a valence that leaves each of its elements this many right angles in the mean.
int forced_cost(double right_angles) {
  const double eta = std::max(0.0, 1 - std::abs(right_angles - 1));
  return static_cast<int>(std::ceil(kForcedBad * std::max(0.0, 1 - 2 * eta) - 1e-9));
}

/// Returns the mean of neighbors of `from`'s origin, strictly between `from` and `to` counterclockwise.
Vec2 middle_between(const QuadTopology& mesh, int from, int to) {
  Vec2 sum;
  int n = 0;
  for (int h = mesh.around(from); h != to; h = mesh.around(h), ++n) sum += mesh.point(mesh.target(h));
  return (1.0 / n) * sum;
}

/// Applies a split. The new vertex and, if interior, the old one move a little into their own parts.
void apply_split(QuadTopology& mesh, const TreatmentMove& move) {
  constexpr double kPart = 0.25;
  const int v = mesh.origin(move.at), opened = mesh.vertex_slots();
  const Vec2 at = mesh.point(v), there = middle_between(mesh, move.at, move.to);
  Vec2 here = at;
  if (!mesh.on_boundary(v)) here = middle_between(mesh, move.to, move.at);
  mesh.split(move.at, move.to);
  mesh.move(opened, at + kPart * (there - at));
  if (!mesh.on_boundary(v)) mesh.move(v, at + kPart * (here - at));
}

}  // namespace

ValenceEnergy::ValenceEnergy(const QuadTopology& mesh) : mesh_(mesh) {
  for (std::size_t valence = 0; valence < inside_.size(); ++valence)
    inside_[valence] = misfit(static_cast<int>(valence), kInside);
  for (int v = 0; v < mesh.vertex_slots() && mesh.on_boundary(v); ++v) {
    if (mesh.held(v)) {
      ideal_.push_back({static_cast<double>(mesh.valence(v)), mesh.valence(v)});
      continue;
    }
    double angle = 0;
    if (mesh.vertex_alive(v)) {
      int last = -1;
      mesh.for_each_out(v, [&](int h) { last = h; });
      const Vec2 to = mesh.point(mesh.target(mesh.out(v))) - mesh.point(v);
      const Vec2 from = mesh.point(mesh.origin(mesh.prev(last))) - mesh.point(v);
      angle = std::atan2(cross(to, from), dot(to, from));
      if (angle <= 0) angle += 2 * std::numbers::pi;
    }
    angle /= std::numbers::pi / 2;
    ideal_.push_back({angle, ideal_quads(angle)});
  }
}

int ValenceEnergy::misfit(int valence, const Ideal& ideal) {
  const int off = valence - ideal.valence;
  if (off == 0) return 0;
  const int forced = forced_cost(ideal.angle / valence) - forced_cost(ideal.angle / ideal.valence);
  return off * off + std::max(0, forced);
}

int ValenceEnergy::gain(const TreatmentMove& move) const {
  const QuadTopology& m = mesh_;
  if (move.kind == TreatmentMove::kDoublet) {
    const int h = m.out(move.at);
    return of(move.at) + change(m.target(h), -1) + change(m.origin(m.prev(h)), -1);
  }
  const int h = move.at;
  const int a = m.origin(h), b = m.target(h);
  if (move.kind == TreatmentMove::kSplit) {
    int moving = 0;
    for (int g = h; g != move.to; g = m.around(g)) ++moving;
    return change(a, 1 - moving) + change(b, 1) + change(m.target(move.to), 1) - misfit(moving + 1, kInside);
  }
  if (move.kind == TreatmentMove::kCollapse) {
    const int c = m.target(m.next(h)), d = m.origin(m.prev(h));
    return of(a) + of(c) - of(a, m.valence(a) + m.valence(c) - 2) + change(b, -1) + change(d, -1);
  }
  const int t = m.twin(h);
  const bool opens = move.kind == TreatmentMove::kOpenForward || move.kind == TreatmentMove::kOpenBackward;
  const bool forward = move.kind == TreatmentMove::kRotateForward || move.kind == TreatmentMove::kOpenForward;
  const int p = forward ? m.target(m.next(h)) : m.origin(m.prev(h));
  const int q = forward ? m.target(m.next(t)) : m.origin(m.prev(t));
  const int at_ends = opens ? -2 * misfit(3, {4, 4}) : change(a, -1) + change(b, -1);
  return at_ends + change(p, 1) + change(q, 1);
}

bool ring_divides_sharp_corner(const QuadTopology& mesh, std::span<const int> quads) {
  return std::ranges::any_of(quads, [&](int e) {
    for (int h = 4 * e; h < 4 * e + 4; ++h) {
      const int v = mesh.origin(h);
      if (!mesh.on_boundary(v) || mesh.valence(v) > 1) continue;
      if (mesh.on_boundary(mesh.target(mesh.next(h)))) continue;
      const Vec2 out = mesh.point(mesh.target(h)) - mesh.point(v);
      const Vec2 in = mesh.point(mesh.origin(mesh.prev(h))) - mesh.point(v);
      if (std::abs(std::atan2(cross(out, in), dot(out, in))) < kLeastSharedAngle) return true;
    }
    return false;
  });
}

namespace {

/// Returns whether the move is legal if no vertex is held.
bool is_legal_if_free(const QuadTopology& mesh, const TreatmentMove& move) {
  switch (move.kind) {
    case TreatmentMove::kCollapse:
      return mesh.can_collapse(move.at);
    case TreatmentMove::kDoublet:
      return mesh.can_remove_doublet(move.at);
    case TreatmentMove::kInset: {
      const std::array<int, 1> self{QuadTopology::element(move.at)};
      return mesh.is_quad(self[0]) && !ring_divides_sharp_corner(mesh, self);
    }
    case TreatmentMove::kSplit:
      return mesh.can_split(move.at, move.to);
    case TreatmentMove::kOpenForward:
    case TreatmentMove::kOpenBackward:
      return mesh.can_open(move.at);
    default:
      return mesh.can_rotate(move.at, move.kind == TreatmentMove::kRotateForward);
  }
}

/// Returns whether the move would change the valence of a held vertex, or give it an edge that another of its
/// fans may have.
bool disturbs_held(const QuadTopology& mesh, const TreatmentMove& move) {
  if (!mesh.any_held() || move.kind == TreatmentMove::kInset) return false;
  if (move.kind == TreatmentMove::kCollapse && mesh.near_held(mesh.target(mesh.next(move.at)))) return true;
  if (move.kind == TreatmentMove::kDoublet) return mesh.near_held(move.at);
  return std::ranges::any_of(touched_by(mesh, move), [&](int v) { return mesh.held(v); });
}

}  // namespace

bool is_legal(const QuadTopology& mesh, const TreatmentMove& move) {
  return is_legal_if_free(mesh, move) && !disturbs_held(mesh, move);
}

void apply(QuadTopology& mesh, const TreatmentMove& move) {
  switch (move.kind) {
    case TreatmentMove::kCollapse: {
      const int kept = mesh.origin(move.at), gone = mesh.target(mesh.next(move.at));
      const Vec2 middle = 0.5 * (mesh.point(kept) + mesh.point(gone));
      mesh.collapse(move.at);
      if (!mesh.on_boundary(kept)) mesh.move(kept, middle);
      break;
    }
    case TreatmentMove::kDoublet:
      mesh.remove_doublet(move.at);
      break;
    case TreatmentMove::kInset:
      mesh.pillow(std::array<int, 1>{QuadTopology::element(move.at)});
      break;
    case TreatmentMove::kSplit:
      apply_split(mesh, move);
      break;
    case TreatmentMove::kOpenForward:
    case TreatmentMove::kOpenBackward:
      mesh.open(move.at, move.kind == TreatmentMove::kOpenForward);
      break;
    default:
      mesh.rotate(move.at, move.kind == TreatmentMove::kRotateForward);
  }
}

void apply(QuadTopology& mesh, QuadRelocation& relocation, const TreatmentMove& move,
           std::vector<int>& touched) {
  const int first = mesh.vertex_slots();
  apply(mesh, move);
  if (first == mesh.vertex_slots()) return;
  relocation.adopt_new_vertices(first);
  for (int v = first; v < mesh.vertex_slots(); ++v) touched.push_back(v);
}

TouchedVertices touched_by(const QuadTopology& mesh, const TreatmentMove& move) {
  switch (move.kind) {
    case TreatmentMove::kCollapse: {
      const int h = move.at;
      return {{mesh.origin(h), mesh.target(h), mesh.origin(mesh.prev(h))}, 3};
    }
    case TreatmentMove::kDoublet: {
      TouchedVertices touched;
      mesh.for_each_out(move.at, [&](int h) {
        touched.v[touched.n++] = mesh.target(h);
        if (mesh.is_quad(QuadTopology::element(h))) touched.v[touched.n++] = mesh.target(mesh.next(h));
      });
      return touched;
    }
    case TreatmentMove::kInset: {
      const int h = move.at;
      return {{mesh.origin(h), mesh.target(h), mesh.target(mesh.next(h)), mesh.origin(mesh.prev(h))}, 4};
    }
    case TreatmentMove::kSplit:
      return {{mesh.origin(move.at), mesh.target(move.at), mesh.target(move.to)}, 3};
    default:
      return {mesh.hexagon(move.at), 6};
  }
}

std::optional<TreatmentMove> MoveQueue::pop() {
  while (!queue_.empty()) {
    check_cancelled();
    const Candidate candidate = queue_.top();
    queue_.pop();
    // Several elements and vertices propose the same move.
    if (candidate.gain == last_.gain && candidate.move == last_.move) continue;
    last_ = candidate;
    if (!is_legal(mesh_, candidate.move)) continue;
    const int gain = energy_.gain(candidate.move);
    if (gain <= 0) continue;
    if (gain == candidate.gain) return candidate.move;
    queue_.push({gain, candidate.move});
  }
  last_ = {0, {}};
  return std::nullopt;
}

}  // namespace delquad
