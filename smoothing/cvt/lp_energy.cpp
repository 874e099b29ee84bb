// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/lp_energy.h"

#include <cmath>
#include <utility>

#include "base/located.h"
#include "smoothing/cvt/blocks.h"
#include "smoothing/cvt/cell_walk.h"
#include "smoothing/cvt/simplex_energy.h"

namespace delquad {
namespace {

/// Turns vectors into a seed's frame and back.
struct Turn {
  Vec2 axis;
  Vec2 in(Vec2 v) const { return {dot(axis, v), cross(axis, v)}; }
  Vec2 out(Vec2 v) const { return {axis.x * v.x - axis.y * v.y, axis.y * v.x + axis.x * v.y}; }
};

/// Sums up a cell: its energy, and derivatives by its seed and the ends of its edges.
template <int P>
class CellEnergy {
 public:
  CellEnergy(Vec2 seed, Turn turn, double weight) : seed_(seed), turn_(turn), weight_(weight) {}

  Vec2 corner(Vec2 x) const { return turn_.in(x - seed_); }
  /// Adds the triangle of the seed and two corners. Returns its derivatives by them in the seed's frame.
  SimplexEnergy add(Vec2 first, Vec2 second) {
    const SimplexEnergy s = simplex_energy<P>(first, second);
    energy_ += s.value;
    by_seed_ += -(s.by_first + s.by_second);
    return s;
  }
  /// Does the same, and adds the derivatives to `by_first` and `by_second`.
  void add(Vec2 first, Vec2 second, Vec2* by_first, Vec2* by_second) {
    const SimplexEnergy s = add(first, second);
    if (by_first != nullptr) *by_first += out(s.by_first);
    if (by_second != nullptr) *by_second += out(s.by_second);
  }
  Vec2 out(Vec2 derivative) const { return turn_.out(weight_ * derivative); }
  double energy() const { return weight_ * energy_; }
  Vec2 by_seed() const { return out(by_seed_); }

 private:
  Vec2 seed_;
  Turn turn_;
  double weight_, energy_ = 0;
  Vec2 by_seed_;
};

struct Arrays {
  const TriPatch& tri;
  const BoundedVoronoi& cells;
  const SeedFrames& frames;
  std::vector<double>& energy;
  std::vector<Vec2>&by_centre, &by_clip, &gradient;

  double weight(std::size_t i) const {
    return frames.weight[i] * std::exp(dot(frames.slope[i], tri.points[i] - frames.from[i]));
  }
  /// Returns where the derivative by an end of an edge of this cell is summed up.
  Vec2* slot(int seed, const CellEnd& end) const {
    if (end.kind == CellEnd::kCentre) return &by_centre[end.index];
    if (end.kind == CellEnd::kClip) return &by_clip[2 * end.index + (cells.clips()[end.index].to == seed)];
    return nullptr;
  }
};

/// Adds a cell whose corners are the circumcenters around its seed.
template <int P>
void add_whole_cell(const MovingDelaunay& delaunay, const Arrays& a, int seed, CellEnergy<P>& cell) {
  Vec2 first, last;        // corners
  Vec2 by_first, by_last;  // partial derivatives by them
  int first_at = -1, last_at = -1;
  const auto edge_to = [&](Vec2 corner) {
    const SimplexEnergy s = cell.add(last, corner);
    if (last_at == first_at)
      by_first = s.by_first;
    else
      a.by_centre[last_at] = cell.out(by_last + s.by_first);
    by_last = s.by_second;
  };
  for_each_corner(delaunay, seed, [&](int t, int k) {
    const Vec2 here = cell.corner(a.cells.centres()[t]);
    if (last_at >= 0)
      edge_to(here);
    else {
      first = here;
      first_at = 3 * t + k;
    }
    last = here;
    last_at = 3 * t + k;
  });
  edge_to(first);
  a.by_centre[first_at] = cell.out(by_last + by_first);
}

/// Adds a cell that ends on the boundary.
template <int P>
void add_cut_cell(const MovingDelaunay& delaunay, const Arrays& a, int seed, CellEnergy<P>& cell) {
  for_each_corner(delaunay, seed, [&](int t, int k) { a.by_centre[3 * t + k] = {}; });
  walk_cell(delaunay, a.cells, seed, [&](const CellEnd& first, const CellEnd& second) {
    cell.add(cell.corner(first.at), cell.corner(second.at), a.slot(seed, first), a.slot(seed, second));
  });
}

/// Adds the edges between cells for seeds begin .. end - 1.
template <int P>
void add_cells(const MovingDelaunay& delaunay, const Arrays& a, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const int seed = static_cast<int>(i);
    CellEnergy<P> cell(a.tri.points[i], {a.frames.axis[i]}, a.weight(i));
    if (a.cells.is_cut(seed))
      add_cut_cell(delaunay, a, seed, cell);
    else
      add_whole_cell(delaunay, a, seed, cell);
    a.energy[i] = cell.energy();
    a.gradient[i] = cell.by_seed();
  }
}

/// Adds the triangles between seeds and pieces of the boundary that do not end in them.
template <int P>
void add_pieces(const Arrays& a) {
  for (const BoundedVoronoi::Piece& piece : a.cells.pieces()) {
    const int i = piece.seed;
    CellEnergy<P> cell(a.tri.points[i], {a.frames.axis[i]}, a.weight(i));
    const auto end_of = [&](int clip) { return CellEnd{CellEnd::kClip, clip, a.cells.clips()[clip].at}; };
    const CellEnd first = end_of(piece.from), second = end_of(piece.to);
    cell.add(cell.corner(first.at), cell.corner(second.at), a.slot(i, first), a.slot(i, second));
    a.energy[i] += cell.energy();
    a.gradient[i] += cell.by_seed();
  }
}

/// Turns derivatives by circumcenters into derivatives by the seeds around them. The circumcenter C of i, j,
/// k moves by (x_j - x_i).dC = (x_j - C).dx_j - (x_i - C).dx_i, and likewise for k.
void chain_through_centres(const Arrays& a, std::size_t begin, std::size_t end) {
  for (std::size_t t = begin; t < end; ++t) {
    Vec2* by = &a.by_centre[3 * t];
    const Vec2 g = by[0] + by[1] + by[2];
    if (a.cells.is_blind(static_cast<int>(t))) {
      by[0] = by[1] = by[2] = {};
      continue;
    }
    const auto& v = a.tri.triangles[t];
    const Vec2 c = a.cells.centres()[t];
    const Vec2 to_j = a.tri.points[v[1]] - a.tri.points[v[0]], to_k = a.tri.points[v[2]] - a.tri.points[v[0]];
    const double det = cross(to_j, to_k);
    const double lambda_j = cross(g, to_k) / det, lambda_k = cross(to_j, g) / det;
    by[0] = -(lambda_j + lambda_k) * (a.tri.points[v[0]] - c);
    by[1] = lambda_j * (a.tri.points[v[1]] - c);
    by[2] = lambda_k * (a.tri.points[v[2]] - c);
  }
}

/// Does the same for clips, which move only along their boundary edge.
void chain_through_clips(const Arrays& a) {
  for (std::size_t c = 0; c < a.cells.clips().size(); ++c) {
    const BoundedVoronoi::Clip& clip = a.cells.clips()[c];
    const Vec2 g = a.by_clip[2 * c] + a.by_clip[2 * c + 1];
    const Vec2 from = a.tri.points[clip.from], to = a.tri.points[clip.to];
    const double lambda = dot(g, clip.direction) / dot(to - from, clip.direction);
    a.gradient[clip.from] += -lambda * (from - clip.at);
    a.gradient[clip.to] += lambda * (to - clip.at);
  }
}

template <int P>
void evaluate_cells(const MovingDelaunay& delaunay, const Arrays& a) {
  const std::size_t n = a.tri.points.size();
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) { add_cells<P>(delaunay, a, begin, end); });
  add_pieces<P>(a);
  parallel_blocks(a.tri.triangles.size(),
                  [&](std::size_t begin, std::size_t end) { chain_through_centres(a, begin, end); });
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      a.gradient[i] += a.energy[i] * a.frames.slope[i];
      for_each_corner(delaunay, static_cast<int>(i),
                      [&](int t, int k) { a.gradient[i] += a.by_centre[3 * t + k]; });
    }
  });
  chain_through_clips(a);
}

}  // namespace

void check_norm(int p) {
  if (p < 2 || p > 16 || p % 2 != 0) refuse("p is {}: expected an even number from 2 to 16", p);
}

LpEnergy::LpEnergy(int p) : p_(p) { check_norm(p); }

double LpEnergy::evaluate(const MovingDelaunay& delaunay, const BoundedVoronoi& cells,
                          const SeedFrames& frames, std::vector<Vec2>& gradient) {
  const TriPatch& tri = delaunay.patch();
  energy_.resize(tri.points.size());
  gradient.resize(tri.points.size());
  by_centre_.resize(3 * tri.triangles.size());
  by_clip_.assign(2 * cells.clips().size(), {});
  const Arrays arrays{tri, cells, frames, energy_, by_centre_, by_clip_, gradient};
  const auto evaluate_all = [&]<int... kHalf>(std::integer_sequence<int, kHalf...>) {
    ((p_ == 2 * kHalf + 2 ? evaluate_cells<2 * kHalf + 2>(delaunay, arrays) : void()), ...);
  };
  evaluate_all(std::make_integer_sequence<int, 8>());
  for (int i = 0; i < tri.n_boundary; ++i) gradient[i] = {};
  return sum_of_blocks(energy_.size(), [&](std::size_t i) { return energy_[i]; });
}

}  // namespace delquad
