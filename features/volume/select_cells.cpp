// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/hexahedra_steps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

#include "base/box_tree.h"
#include "base/parallel_each.h"
#include "base/sort_unique.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/find_crossings.h"
#include "metrics/cells.h"

namespace delquad {
namespace {

/// Least scaled Jacobian of a hexahedron.
constexpr double kLeastJacobian = 0.3;
constexpr int kExchangeRounds = 4;
/// Worth of a side that two hexahedra share, in the sum of their volumes. On the skin it counts twice.
constexpr double kSideWorth = 0.05;
/// Most hexahedra with the same first vertex, the best ones.
constexpr std::size_t kMostAtVertex = 12;
/// Centers nearer than this, in the shorter mean edge, mean an overlap.
constexpr double kTooNear = 0.5;
/// Least angle between hexahedra that share an edge, but no side.
constexpr double kLeastWedge = 15 * std::numbers::pi / 180;
constexpr double kSkinWedge = 20 * std::numbers::pi / 180;
/// Least gap between hexahedra that share nothing, in their mean edge.
constexpr double kLeastGap = 0.08;

using cell_tables::kHexEdges, cell_tables::kHexSides;

/// The three corners beside each corner, so that their directions are right-handed.
constexpr std::array<std::array<int, 3>, 8> kBeside = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

bool is_edge(int a, int b) {
  const auto& [x, y, z] = kBeside[a];
  return b == x || b == y || b == z;
}

using Corners = std::array<Vec3, 8>;

Quad side_of(const Hexahedron& hex, int s) {
  return Solid{&solid_shape(CellShape::kHexahedron), hex}.side(s);
}

/// A hexahedron with all that tests of pairs need.
struct Placed {
  Hexahedron hex;
  Corners x;
  Vec3 centre;
  double edge;                  ///< mean length
  std::array<Vec3, 6> normals;  ///< of sides, outwards
  std::array<Vec3, 3> axes;     ///< mean edges
};

Placed placed(const std::vector<Vec3>& points, const Hexahedron& hex) {
  Placed s{hex, corners_of(points, hex), middle_of(points, hex), 0, {}, {}};
  for (const auto& [a, b] : kHexEdges) s.edge += norm(s.x[b] - s.x[a]) / 12;
  for (int k = 0; k < 6; ++k) {
    const auto& f = kHexSides[k];
    s.normals[k] = cross(s.x[f[2]] - s.x[f[0]], s.x[f[3]] - s.x[f[1]]);
  }
  for (int k = 0; k < 3; ++k) {
    const auto& f = kHexSides[std::array{3, 4, 1}[k]];
    s.axes[k] = s.x[f[0]] + s.x[f[1]] + s.x[f[2]] + s.x[f[3]] - 4 * s.centre;
  }
  return s;
}

/// Returns whether a plane across n separates all corners by `gap`.
bool is_between(const Placed& a, const Placed& b, const Vec3& n, double gap) {
  double most = -INFINITY, least = INFINITY;
  for (int k = 0; k < 8; ++k) most = std::max(most, dot(n, a.x[k])), least = std::min(least, dot(n, b.x[k]));
  return least - most >= gap * norm(n);
}

bool are_apart(const Placed& a, const Placed& b) {
  const double gap = kLeastGap * 0.5 * (a.edge + b.edge);
  if (is_between(a, b, b.centre - a.centre, gap)) return true;
  for (int k = 0; k < 6; ++k)
    if (is_between(a, b, a.normals[k], gap) || is_between(a, b, -1.0 * b.normals[k], gap)) return true;
  for (const Vec3& u : a.axes)
    for (const Vec3& v : b.axes) {
      const Vec3 n = cross(u, v);
      if (norm(n) < 1e-3 * norm(u) * norm(v)) continue;
      if (is_between(a, b, n, gap) || is_between(a, b, -1.0 * n, gap)) return true;
    }
  return false;
}

/// Returns whether a plane through the common corner i of a, j of b separates them.
bool are_apart_at(const Placed& a, int i, const Placed& b, int j) {
  const Vec3 v = a.x[i];
  const auto separates = [&](const Vec3& n) {
    for (int k = 0; k < 8; ++k)
      if ((k != i && dot(n, a.x[k] - v) >= 0) || (k != j && dot(n, b.x[k] - v) <= 0)) return false;
    return true;
  };
  if (separates(b.centre - a.centre)) return true;
  std::array<Vec3, 3> e, f;
  for (int k = 0; k < 3; ++k) e[k] = a.x[kBeside[i][k]] - v, f[k] = b.x[kBeside[j][k]] - v;
  const Vec3 inner = (1 / b.edge) * (b.centre - v) - (1 / a.edge) * (a.centre - v);
  if (separates(inner)) return true;
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = cross(e[(k + 1) % 3], e[k]), m = cross(f[k], f[(k + 1) % 3]);
    const Vec3 sum = (1 / norm(n)) * n + (1 / norm(m)) * m;
    const Vec3 tilt = 0.02 * norm(n) / norm(inner) * inner, tilt2 = 0.02 * norm(m) / norm(inner) * inner;
    if (separates(n + tilt) || separates(m + tilt2) || separates(sum)) return true;
  }
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      Vec3 n = cross(e[k], f[l]);
      if (dot(n, inner) < 0) n = -1.0 * n;
      if (separates(n) || separates(n + 0.02 * norm(n) / norm(inner) * inner)) return true;
    }
  return false;
}

/// A hexahedron around one of its edges, 0 at its center.
struct Wedge {
  AngleAround angle;
  double least = 0, most = 0;  ///< of the other corners

  Wedge(const Corners& at, const Vec3& centre, int i, int j) : angle(at[i], at[j], centre) {
    for (int k = 0; k < 8; ++k) {
      if (k == i || k == j) continue;
      const double t = angle(at[k]);
      most = std::max(most, t), least = std::min(least, t);
    }
  }
  /// Returns whether a point lies beyond the wedge by an angle.
  bool is_clear(const Vec3& p, double by) const {
    const double t = angle(p), turned = t < 0 ? t + 2 * std::numbers::pi : t;
    return turned >= most + by && turned <= 2 * std::numbers::pi + least - by;
  }
};

/// Returns whether the hexahedra lie in disjoint wedges around their common edge.
bool are_apart_around(const Placed& a, const Placed& b, int i, int j) {
  const Wedge wedge(a.x, a.centre, i, j);
  for (int k = 0; k < 8; ++k)
    if (b.hex[k] != a.hex[i] && b.hex[k] != a.hex[j] && !wedge.is_clear(b.x[k], kLeastWedge)) return false;
  return true;
}

bool are_compatible(const Placed& a, const Placed& b) {
  if (norm(a.centre - b.centre) < kTooNear * std::min(a.edge, b.edge)) return false;
  std::array<int, 8> i, j;  // shared corners
  int n = 0;
  for (int k = 0; k < 8; ++k)
    for (int l = 0; l < 8; ++l)
      if (a.hex[k] == b.hex[l]) i[n] = k, j[n++] = l;
  if (n == 0) return are_apart(a, b);
  if (n == 1) return are_apart_at(a, i[0], b, j[0]);
  if (n == 2) return is_edge(i[0], i[1]) && is_edge(j[0], j[1]) && are_apart_around(a, b, i[0], i[1]);
  for (int s = 0; s < 6 && n == 4; ++s)
    for (int t = 0; t < 6; ++t) {
      const Quad f = side_of(a.hex, s), g = side_of(b.hex, t);
      if (side_key(f) == side_key(g)) return same_turn(f, {g[3], g[2], g[1], g[0]});
    }
  return false;
}

/// The edges and quads of the skin.
class SkinParts {
 public:
  SkinParts(std::size_t n_points, const std::vector<Quad>& quads) : at_(n_points), quads_(quads) {
    for (std::size_t q = 0; q < quads.size(); ++q)
      for (const int v : quads[q]) at_[v].push_back(static_cast<int>(q));
  }
  bool on(int v) const { return !at_[v].empty(); }
  /// Returns the quads with both points, the first one first.
  std::vector<Quad> with(int a, int b) const {
    std::vector<Quad> found;
    for (const int q : at_[a])
      if (std::ranges::find(quads_[q], b) != quads_[q].end()) {
        Quad& quad = found.emplace_back(quads_[q]);
        std::ranges::rotate(quad, std::ranges::find(quad, a));
      }
    return found;
  }
  bool has(const Quad& side) const {
    return std::ranges::any_of(at_[side[0]], [&](int q) { return side_key(quads_[q]) == side_key(side); });
  }

 private:
  std::vector<std::vector<int>> at_;
  const std::vector<Quad>& quads_;
};

/// Least distance from the skin of the middle of sides and edges inside that end there, in mean edges.
constexpr double kOffSkin = 0.1;

/// Returns whether a hexahedron meets the skin only in its vertices, sides and quads.
bool fits_skin(const Hexahedron& hex, const std::vector<Vec3>& points, const SkinParts& parts,
               const Skin& skin) {
  double gap = 0;
  for (const auto& [a, b] : kHexEdges) gap += kOffSkin / 12 * norm(points[hex[a]] - points[hex[b]]);
  const auto is_inside = [&](const Vec3& x) { return skin.distance(x, gap) > gap && skin.contains(x); };
  int n_on = 0;
  for (const int v : hex) n_on += parts.on(v);
  if (n_on < 2) return true;
  const auto has = [](const auto& nodes, int v) { return std::ranges::find(nodes, v) != nodes.end(); };
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) {
      const int a = hex[i], b = hex[j];
      if (!parts.on(a) || !parts.on(b)) continue;
      const std::vector<Quad> quads = parts.with(a, b);
      const bool is_side = std::ranges::any_of(quads, [&](const Quad& q) { return q[2] != b; });
      if (!is_edge(i, j)) {
        // A diagonal must lie in a side that is a quad of the skin.
        bool is_diagonal = quads.empty();
        for (int s = 0; s < 6; ++s) {
          const Quad side = side_of(hex, s);
          is_diagonal |= has(side, a) && has(side, b) && parts.has(side);
        }
        if (is_side || !is_diagonal) return false;
      } else if (quads.empty()) {
        if (!is_inside(0.5 * (points[a] + points[b]))) return false;
      } else if (!is_side) {
        return false;
      } else {
        const Wedge wedge(corners_of(points, hex), middle_of(points, hex), i, j);
        for (const Quad& quad : quads) {
          if (std::ranges::all_of(quad, [&](int v) { return has(hex, v); })) continue;
          for (const int v : quad)
            if (v != a && v != b && !wedge.is_clear(points[v], kSkinWedge)) return false;
        }
      }
    }
  for (int s = 0; s < 6; ++s) {
    const Quad side = side_of(hex, s);
    int on = 0;
    Vec3 sum{0, 0, 0};
    for (const int v : side)
      if (parts.on(v)) ++on, sum = sum + points[v];
    if (on < 3 || (on == 4 && parts.has(side))) continue;
    if (!is_inside((1.0 / on) * sum)) return false;
  }
  return true;
}

/// Returns the candidates that each one excludes, ascending.
std::vector<std::vector<int>> rivals_of(const std::vector<Vec3>& points,
                                        const std::vector<Hexahedron>& candidates) {
  std::vector<Placed> all;
  std::vector<Box<Vec3>> boxes;
  for (const Hexahedron& hex : candidates) {
    all.push_back(placed(points, hex));
    boxes.push_back(Box<Vec3>::around(std::span(all.back().x)).grown(kLeastGap * all.back().edge));
  }
  const BoxTree<Vec3> tree(boxes);
  std::vector<std::vector<int>> rivals(candidates.size());
  parallel_each(all.size(), [&](std::size_t i) {
    tree.overlapping(boxes[i], [&](int j) {
      if (static_cast<int>(i) < j && boxes[i].overlaps(boxes[j]) && !are_compatible(all[i], all[j]))
        rivals[i].push_back(j);
    });
  });
  for (int i = 0; i < static_cast<int>(rivals.size()); ++i)
    for (const int j : std::vector(rivals[i]))
      if (j > i) rivals[j].push_back(i);
  for (auto& list : rivals) sort_unique(list);
  return rivals;
}

/// Chooses candidates of which no two are rivals, of great worth together. Two chosen mates add the worth of
/// the side of each.
class Choice {
 public:
  Choice(const Mesh& body, const std::vector<Hexahedron>& candidates)
      : rivals_(rivals_of(body.points, candidates)),
        mates_(candidates.size()),
        against_(candidates.size(), 0),
        is_chosen_(candidates.size(), 0) {
    std::map<Quad, std::vector<int>> by_side;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto corners = corners_of(body.points, candidates[i]);
      const double volume = signed_volume(corners);
      side_worth_.push_back(kSideWorth * volume);
      worth_.push_back(volume * (1 + 0.5 * scaled_jacobian(corners)));
      for (int s = 0; s < 6; ++s) by_side[side_key(side_of(candidates[i], s))].push_back(static_cast<int>(i));
    }
    for (const auto& [side, at] : by_side)
      for (const int i : at)
        for (const int j : at)
          if (i != j && !std::ranges::binary_search(rivals_[i], j)) mates_[i].push_back(j);
    for (const Quad& q : body.quads)
      if (const auto found = by_side.find(side_key(q)); found != by_side.end())
        for (const int i : found->second) worth_[i] += 2 * side_worth_[i];
    std::vector<int> all(worth_.size());
    std::iota(all.begin(), all.end(), 0);
    add_best(all);
    std::vector<char> waits(worth_.size(), 1);
    for (int round = 0; round < kExchangeRounds; ++round)
      for (const int i : all) {
        if (std::exchange(waits[i], 0) == 0 || has(i) || !exchange(i)) continue;
        for (const int j : toggled_)
          for (const int k : rivals_[j]) waits[k] = 1;
      }
  }

  bool has(int i) const { return is_chosen_[i]; }

 private:
  double gain(int i) const {
    double sum = worth_[i];
    for (const int j : mates_[i])
      if (has(j)) sum += side_worth_[i] + side_worth_[j];
    return sum;
  }
  void toggle(int i) {
    is_chosen_[i] ^= 1;
    total_ += has(i) ? gain(i) : -gain(i);
    for (const int j : rivals_[i]) against_[j] += has(i) ? 1 : -1;
    toggled_.push_back(i);
  }
  /// Adds candidates without chosen rivals, best first.
  void add_best(const std::vector<int>& from) {
    std::priority_queue<std::pair<double, int>> queue;
    for (const int i : from) queue.push({gain(i), -i});
    while (!queue.empty()) {
      const auto [value, minus] = queue.top();
      queue.pop();
      if (has(-minus) || against_[-minus] > 0 || value != gain(-minus)) continue;
      toggle(-minus);
      for (const int j : mates_[-minus])
        if (!has(j) && against_[j] == 0) queue.push({gain(j), -j});
    }
  }
  /// Takes a candidate in place of its rivals, and others where these leave room, if that is worth more.
  bool exchange(int i) {
    const double before = total_;
    toggled_.clear();
    for (const int j : rivals_[i])
      if (has(j)) toggle(j);
    std::vector<int> free;
    const std::vector<int> out = toggled_;
    toggle(i);
    for (const int j : out)
      for (const int k : rivals_[j])
        if (against_[k] == 0 && !has(k)) free.push_back(k);
    add_best(free);
    if (total_ > before * (1 + 1e-9)) return true;
    for (std::size_t left = toggled_.size(); left > 0; --left) toggle(toggled_[left - 1]);
    total_ = before;
    return false;
  }

  std::vector<std::vector<int>> rivals_, mates_;
  std::vector<double> side_worth_, worth_;
  std::vector<int> against_;  ///< number of chosen rivals
  std::vector<char> is_chosen_;
  std::vector<int> toggled_;  ///< since the exchange began
  double total_ = 0;
};

}  // namespace

std::vector<Hexahedron> find_hexahedra(const std::vector<Vec3>& points,
                                       const std::vector<std::vector<int>>& beside, const Skin& skin) {
  const SkinParts parts(points.size(), skin.body().quads);
  std::vector<std::vector<Hexahedron>> found(points.size());
  parallel_each(points.size(), [&](std::size_t i) {
    std::vector<int> ab, bc, ca, last;
    const int v = static_cast<int>(i);
    const auto common = [&](int a, int b, std::vector<int>& into) {
      into.clear();
      std::ranges::set_intersection(beside[a], beside[b], std::back_inserter(into));
      std::erase_if(into, [&](int w) { return w <= v; });
    };
    const auto is_corner = [&](int at, int a, int b, int c) {
      const Vec3 e = points[a] - points[at], f = points[b] - points[at], g = points[c] - points[at];
      return dot(e, cross(f, g)) >= kLeastJacobian * norm(e) * norm(f) * norm(g);
    };
    const auto& near = beside[v];
    std::vector<std::pair<double, Hexahedron>> here;
    for (const int a : near)
      for (const int b : near)
        for (const int c : near) {
          if (a <= v || b <= a || c <= a || b == c) continue;
          if (!is_corner(v, a, b, c)) continue;
          common(a, b, ab);
          if (ab.empty()) continue;
          common(b, c, bc);
          if (bc.empty()) continue;
          common(c, a, ca);
          for (const int x : ab)
            for (const int y : bc)
              for (const int z : ca) {
                if (x == c || y == a || z == b || x == y || y == z || z == x) continue;
                if (!is_corner(a, x, v, z) || !is_corner(b, v, x, y) || !is_corner(c, y, z, v)) continue;
                common(x, y, last);
                for (const int w : last) {
                  if (w == a || w == b || w == c || w == z || !std::ranges::binary_search(beside[w], z))
                    continue;
                  const Hexahedron hex = {v, a, x, b, c, z, w, y};
                  if (const double quality = scaled_jacobian(corners_of(points, hex));
                      quality >= kLeastJacobian && is_positive(corners_of(points, hex)))
                    here.emplace_back(-quality, hex);
                }
              }
        }
    std::ranges::sort(here);
    for (const auto& [quality, hex] : here) {
      if (found[i].size() >= kMostAtVertex) break;
      if (fits_skin(hex, points, parts, skin)) found[i].push_back(hex);
    }
  });
  std::vector<Hexahedron> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  return all;
}

void select_hexahedra(Mesh& body, const std::vector<Hexahedron>& candidates) {
  const Choice choice(body, candidates);
  body.hexahedra.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (choice.has(static_cast<int>(i))) body.hexahedra.push_back(candidates[i]);
  drop_cells(body, {});
}

void separate_sides(Mesh& body) {
  for (std::vector<int> worse(1); !worse.empty();) {
    const auto [quads, none, owners] = open_faces(body);
    std::vector<Triangle> triangles;
    double length = 0;
    for (const Quad& q : quads) {
      for (int k = 0; k < 4; ++k) triangles.push_back({q[k], q[(k + 1) % 4], q[(k + 2) % 4]});
      length += norm(body.points[q[1]] - body.points[q[0]]) / static_cast<double>(quads.size());
    }
    const auto may_cross = [&, &owners = owners](int a, int b) {
      return a / 4 == b / 4 || (owners[a / 4] >= 0 && owners[b / 4] >= 0);
    };
    const auto quality = [&](int owner) {  // quads of the skin stay
      return owner >= 0 ? 2 : scaled_jacobian(corners_of(body.points, body.hexahedra[-1 - owner]));
    };
    worse.clear();
    for (const Crossing& c : find_crossings(body.points, triangles, may_cross, 1e-3 * length)) {
      const int a = owners[c.first / 4], b = owners[c.second / 4];
      worse.push_back(-1 - (quality(a) < quality(b) ? a : b));
    }
    drop_cells(body, worse);
  }
}

}  // namespace delquad
