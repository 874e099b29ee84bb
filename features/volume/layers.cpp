// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

#include "base/cancel.h"
#include "base/parallel_each.h"
#include "base/sort_unique.h"
#include "features/volume/hexahedra_steps.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/nearest_triangle.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

/// Most that heights change by length along the skin.
constexpr double kSlope = 0.5;
/// Layers end where less of their height is left.
constexpr double kLeastScale = 0.02, kLeastOfSheet = 0.3;
/// Most that points between planes move, in heights: between planes 47 degrees apart.
constexpr double kLongest = 2.5;
/// Quads see a direction if its cosine with their normals is at least this.
constexpr double kVisible = 0.1;
/// Normals that differ by less are one: what rounding makes of flat surfaces.
constexpr double kSameNormal = 1e-12;
/// Heights shrink by this where cells or fronts are not sound, so often before layers end.
constexpr double kShrink = 0.6;
constexpr int kShrinks = 6;
/// Cells get positive soon or never: their shrinking counts so often.
constexpr int kShrinkOfCells = 3;
/// Rows of quads serve as sides of layers if their heights differ by this factor at most.
constexpr double kSimilar = 2;

/// Returns the unit vector whose least dot product with unit vectors is the largest one, and this product.
std::pair<Vec3, double> best_seen(const std::vector<Vec3>& normals) {
  std::pair<Vec3, double> best{{}, -1};
  const auto offer = [&](const Vec3& v) {
    const double length = norm(v);
    if (length < kSameNormal) return;
    double least = 1;
    for (const Vec3& n : normals) least = std::min(least, dot(n, v) / length);
    if (least > best.second + kSameNormal) best = {(1 / length) * v, least};
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    offer(normals[i]);
    for (std::size_t j = 0; j < i; ++j) {
      offer(normals[i] + normals[j]);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 across = cross(normals[j] - normals[i], normals[k] - normals[i]);
        offer(dot(across, normals[i]) < 0 ? (-1.0) * across : across);
      }
    }
  }
  return best;
}

std::optional<NearestTriangle> nearest_of(const Mesh& body, const std::vector<char>& mark, bool marked) {
  std::vector<Quad> quads;
  for (std::size_t q = 0; q < body.quads.size(); ++q)
    if ((mark[q] != 0) == marked) quads.push_back(body.quads[q]);
  if (quads.empty()) return {};
  return NearestTriangle(body.points, halves_of(quads));
}

class LayerGrower {
 public:
  /// Heights are at most a part of the mean side of quads at a point; 0: any.
  LayerGrower(const Mesh& body, const std::vector<char>& has_layers, std::span<const double> heights,
              double most_of_sides = 0)
      : body_(body),
        has_layers_(has_layers),
        heights_(heights),
        least_scale_(most_of_sides > 0 ? kLeastOfSheet : kLeastScale),
        spokes_(body.points.size()),
        at_(body.points.size()) {
    for (std::size_t q = 0; q < body.quads.size(); ++q)
      for (int k = 0; k < 4; ++k) {
        const Quad& quad = body.quads[q];
        spokes_[quad[k]].push_back({quad[(k + 1) % 4], quad[(k + 3) % 4], static_cast<int>(q)});
        if (has_layers[q] != 0) at_[quad[k]].kind = Kind::kFree;
      }
    find_directions();
    find_rows();
    for (std::size_t v = 0; v < at_.size() && most_of_sides > 0; ++v) {
      double length = 0;
      for (const Spoke& s : spokes_[v]) length += norm(body.points[s.next] - body.points[v]);
      const double n = static_cast<double>(spokes_[v].size());
      at_[v].most = at_[v].limit = std::min(1.0, most_of_sides * length / n / heights.back());
    }
    find_room();
  }

  /// Places points and cells; layers shrink until all cells are positive and fronts do not cross.
  void grow() {
    do {
      check_cancelled();
      while (end_rims() || limit_slopes()) continue;
      place();
    } while (shrink(quads_of_poor_cells(), kShrinkOfCells) || shrink(quads_of_crossings()));
  }

  /// Lets layers shrink at quads of the body, which counts so often; returns whether there are any.
  bool shrink(const std::vector<int>& quads, int times = 1) {
    std::vector<char> done(at_.size(), 0);
    bool any = false;
    for (const int q : quads)
      for (const int v : body_.quads[q]) {
        Place& at = at_[v];
        if ((at.kind != Kind::kFree && at.kind != Kind::kRows) || std::exchange(done[v], 1) != 0) continue;
        any = true;
        at.limit *= kShrink;
        if ((at.shrinks += times) > kShrinks) at.kind = Kind::kEnd;
      }
    return any;
  }

  /// The quads around the body without layers, the folded ones last.
  const std::vector<Quad>& front() const { return front_; }
  /// Splits folded quads of a front into triangles.
  void split_folded(std::vector<Quad>& quads, std::vector<Triangle>& triangles) const {
    triangles = halves_of(std::span(quads).subspan(n_flat_));
    quads.resize(n_flat_);
  }
  /// The quad of the body at a face of such a front, quads first.
  int quad_of(std::size_t face) const {
    return below_[face < n_flat_ ? face : n_flat_ + (face - n_flat_) / 2];
  }

  /// Points, and cells whose volumes are the quads below them.
  const Mesh& cells() const { return cells_; }

  GrownLayers told() const {
    GrownLayers told;
    for (std::size_t q = 0; q < body_.quads.size(); ++q) {
      if (has_layers_[q] == 0) continue;
      if (std::ranges::none_of(body_.quads[q], [&](int v) { return stands(v); }) && ++told.n_bare == 1)
        told.bare_at = body_.points[body_.quads[q][0]];
      for (const int v : body_.quads[q])
        if (at_[v].kind == Kind::kFree && at_[v].limit < told.least)
          told.least = at_[v].limit, told.least_at = body_.points[v];
    }
    return told;
  }

 private:
  /// Points off layers; points that move; points with rows of quads; and points where layers end.
  enum class Kind { kOff, kFree, kRows, kEnd };
  struct Place {
    Kind kind = Kind::kOff;
    Vec3 move;          ///< for a height of 1
    double seen = 1;    ///< least height above planes of quads, for a height of 1
    double most = 1;    ///< wanted part of the height
    double limit = 1;   ///< most part of the height
    double height = 0;  ///< of all layers
    int shrinks = 0;
    std::vector<int> row;  ///< the points of layers
    int first = -1;        ///< point of the first layer
  };
  /// A corner of a quad: the next and the previous corner.
  struct Spoke {
    int next, previous, quad;
  };

  const Spoke* spoke(int v, int next) const {
    const auto found = std::ranges::find(spokes_[v], next, &Spoke::next);
    return found == spokes_[v].end() ? nullptr : &*found;
  }
  bool is_bare(const Spoke& s) const { return has_layers_[s.quad] == 0; }

  /// Whether the quads at a point make one fan.
  bool is_fan(int v) const {
    int x = spokes_[v][0].next;
    for (std::size_t i = 1; i <= spokes_[v].size(); ++i) {
      const Spoke* s = spoke(v, x);
      if (s == nullptr) return false;
      x = s->previous;
      if (x == spokes_[v][0].next) return i == spokes_[v].size();
    }
    return false;
  }

  void find_directions() {
    for (std::size_t v = 0; v < at_.size(); ++v) {
      Place& at = at_[v];
      if (at.kind == Kind::kFree && !is_fan(static_cast<int>(v))) at.kind = Kind::kEnd;
      if (at.kind != Kind::kFree) continue;
      std::vector<Vec3> normals;
      for (const Spoke& s : spokes_[v]) {
        const Vec3 &p = body_.points[v], in = cross(body_.points[s.previous] - p, body_.points[s.next] - p);
        if (is_bare(s))
          at.kind = Kind::kEnd;
        else if (norm(in) > 0 && std::ranges::none_of(normals, [&](const Vec3& n) {
                   return norm(n - direction_of(in)) < kSameNormal;
                 }))
          normals.push_back(direction_of(in));
      }
      const auto [direction, least] = best_seen(normals);
      if (least < kVisible) at.kind = Kind::kEnd;
      const double length = std::min(1 / least, kLongest);
      at.move = length * direction, at.seen = length * least;
    }
  }

  /// Returns the points of layers along quads without layers; empty: there are no rows like layers.
  std::vector<int> row_at(int v) const {
    std::vector<int> row;
    for (const Spoke& s : spokes_[v]) {
      const auto before = std::ranges::find(spokes_[v], s.next, &Spoke::previous);
      if (!is_bare(s) || before == spokes_[v].end() || !is_bare(*before)) continue;
      if (!row.empty()) return {};
      row.push_back(s.next);
    }
    if (row.empty()) return {};
    for (int from = v; row.size() < heights_.size();) {
      const int at = row.back();
      constexpr std::size_t kRegular = 4;
      if (spokes_[at].size() != kRegular || !is_fan(at) || at_[at].kind != Kind::kOff) return {};
      row.push_back(spoke(at, spoke(at, from)->previous)->previous);
      from = at;
    }
    if (at_[row.back()].kind != Kind::kOff) return {};
    const double scale = height_of(row, v, row.size()) / heights_.back();
    for (std::size_t k = 0; k < row.size(); ++k)
      if (const double ratio = height_of(row, v, k + 1) / heights_[k] / scale;
          scale > kSimilar || ratio > kSimilar || ratio * kSimilar < 1)
        return {};
    return row;
  }

  /// The height of the first points of a row above its foot.
  double height_of(const std::vector<int>& row, int foot, std::size_t n) const {
    double sum = 0;
    for (const int w : std::span(row).first(n))
      sum += norm(body_.points[w] - body_.points[std::exchange(foot, w)]);
    return sum;
  }

  /// Finds where layers may stand on rows of quads without layers.
  void find_rows() {
    std::map<Quad, int> bare;
    for (std::size_t q = 0; q < body_.quads.size(); ++q)
      if (has_layers_[q] == 0) bare[side_key(body_.quads[q])] = static_cast<int>(q);
    std::vector<int> owner(at_.size(), -1);
    for (std::size_t v = 0; v < at_.size(); ++v) {
      if (at_[v].kind != Kind::kEnd || !is_fan(static_cast<int>(v))) continue;
      const std::vector<int> row = at_[v].row = row_at(static_cast<int>(v));
      for (const int at : row)
        if (const int other = std::exchange(owner[at], static_cast<int>(v)); other >= 0)
          at_[v].row.clear(), at_[other].row.clear();
    }
    for (std::size_t q = 0; q < body_.quads.size(); ++q)
      for (int k = 0; k < 4 && has_layers_[q] != 0; ++k) {
        const int a = body_.quads[q][k], b = body_.quads[q][(k + 1) % 4];
        const auto across = std::ranges::find(spokes_[a], b, &Spoke::previous);
        if (across == spokes_[a].end() || !is_bare(*across)) continue;
        Rim rim{a, b, {}};
        if (!at_[a].row.empty() && !at_[b].row.empty())
          for (std::size_t i = 0; i < heights_.size(); ++i) {
            const Quad side = {i == 0 ? a : at_[a].row[i - 1], i == 0 ? b : at_[b].row[i - 1], at_[b].row[i],
                               at_[a].row[i]};
            if (const auto found = bare.find(side_key(side)); found != bare.end())
              rim.sides.push_back(found->second);
          }
        if (rim.sides.size() == heights_.size()) at_[a].kind = at_[b].kind = Kind::kRows;
        rims_.push_back(rim);
      }
    for (const Rim& rim : rims_)
      if (rim.sides.size() < heights_.size()) at_[rim.a].kind = at_[rim.b].kind = Kind::kEnd;
  }

  /// Limits heights where other quads are near.
  void find_room() {
    constexpr double kApart = 1;    // between fronts, in heights
    constexpr double kOther = 0.5;  // from fronts to quads without layers, in heights
    constexpr double kOwn = 0.75;   // part of the height at which the own quads still are the nearest
    constexpr int kSteps = 10;
    const auto walls = nearest_of(body_, has_layers_, true), others = nearest_of(body_, has_layers_, false);
    parallel_each(at_.size(), [&](std::size_t v) {
      Place& at = at_[v];
      if (at.kind != Kind::kFree) return;
      const auto fits = [&](double part) {
        const Vec3 top = part * heights_.back() * at.move;
        const double height = part * heights_.back() * at.seen;
        const double own = kOwn * (1 + kApart) * height;
        return walls->find(body_.points[v] + (1 + kApart) * top, own).distance >= own &&
               (!others || others->find(body_.points[v] + top, kOther * height).distance >= kOther * height);
      };
      if (fits(at.limit)) return;
      double low = 0, high = at.limit;
      for (int i = 0; i < kSteps; ++i) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? low : high) = middle;
      }
      at.limit = low;
    });
  }

  /// Ends rows beside ends.
  bool end_rims() {
    bool any = false;
    for (const Rim& rim : rims_)
      if (stands(rim.a) != stands(rim.b)) at_[rim.a].kind = at_[rim.b].kind = Kind::kEnd, any = true;
    return any;
  }

  /// Limits slopes of heights, and ends layers where too little is left.
  bool limit_slopes() {
    using Item = std::pair<double, int>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const int v = static_cast<int>(i);
      Place& at = at_[i];
      at.height = at.kind == Kind::kFree   ? at.limit * heights_.back()
                  : at.kind == Kind::kRows ? height_of(at.row, v, at.row.size())
                                           : 0;
      if (at.kind != Kind::kOff) queue.emplace(at.height, v);
    }
    while (!queue.empty()) {
      const auto [height, v] = queue.top();
      queue.pop();
      if (height > at_[v].height) continue;
      for (const Spoke& s : spokes_[v])
        for (const int w : {s.next, s.previous}) {
          const double most = height + kSlope * norm(body_.points[w] - body_.points[v]);
          if (is_bare(s) || at_[w].kind != Kind::kFree || at_[w].height <= most) continue;
          at_[w].height = most;
          queue.emplace(most, w);
        }
    }
    bool any = false;
    for (Place& at : at_)
      if (at.kind == Kind::kFree && at.height < least_scale_ * at.most * heights_.back())
        at.kind = Kind::kEnd, any = true;
    return any;
  }

  int point(int v, std::size_t level) const {
    const Place& at = at_[v];
    if (level == 0 || at.kind == Kind::kEnd) return v;
    return at.kind == Kind::kRows ? at.row[level - 1] : at.first + static_cast<int>(level) - 1;
  }

  /// Makes points, cells and the front.
  void place() {
    cells_ = {};
    cells_.points = body_.points;
    for (std::size_t v = 0; v < at_.size(); ++v) {
      if (at_[v].kind != Kind::kFree) continue;
      at_[v].first = static_cast<int>(cells_.points.size());
      for (const double height : heights_)
        cells_.points.push_back(body_.points[v] + at_[v].height / heights_.back() * height * at_[v].move);
    }
    std::vector<char> is_side(body_.quads.size(), 0);
    for (const Rim& rim : rims_)
      if (at_[rim.a].kind == Kind::kRows)
        for (const int q : rim.sides) is_side[q] = 1;
    front_.clear(), below_.clear();
    for (const bool is_folded : {false, true}) {
      if (is_folded) n_flat_ = front_.size();
      for (int q = 0; q < static_cast<int>(body_.quads.size()); ++q) {
        if (is_side[q] != 0) continue;
        const bool grows = has_layers_[q] != 0;
        for (std::size_t level = 0; level < heights_.size() && grows && !is_folded; ++level)
          add_cells(q, level);
        const int turn = grows ? fold_of(body_.quads[q]) : -1;
        if ((turn >= 0) != is_folded) continue;
        Quad& top = front_.emplace_back(body_.quads[q]);
        for (int& v : top) v = grows ? point(v, heights_.size()) : v;
        std::ranges::rotate(top, top.begin() + std::max(turn, 0));
        below_.push_back(q);
      }
    }
  }

  bool stands(int v) const { return at_[v].kind != Kind::kEnd; }

  /// The first corner of the diagonal that tops of layers are folded along; -1: they are quads. Layers stand
  /// at both its ends, or at the first alone.
  int fold_of(const Quad& quad) const {
    const auto n = std::ranges::count_if(quad, [&](int v) { return stands(v); });
    for (int k = 0; k < 4 && n > 0 && n < 4; ++k)
      if (stands(quad[k]) && (n == 1 || stands(quad[(k + 2) % 4]))) return k;
    return -1;
  }

  void add_cells(int q, std::size_t level) {
    Quad quad = body_.quads[q];
    std::ranges::reverse(quad);
    const auto n_ends = std::ranges::count_if(quad, [&](int v) { return !stands(v); });
    if (n_ends == 4) return;
    const int fold = fold_of(quad);
    while (n_ends > 0 && fold < 0 && (stands(quad[0]) || stands(quad[1])))
      std::ranges::rotate(quad, quad.begin() + 1);
    std::ranges::rotate(quad, quad.begin() + std::max(fold, 0));
    std::array<int, 8> hex;
    for (int k = 0; k < 4; ++k) hex[k] = point(quad[k], level), hex[k + 4] = point(quad[k], level + 1);
    if (n_ends == 0)
      add_cell(cells_, hex, q);
    else if (fold < 0)
      add_cell(cells_, std::array{hex[0], hex[3], hex[7], hex[1], hex[2], hex[6]}, q);
    else if (level > 0)
      add_half(hex, 1, 2, q), add_half(hex, 2, 3, q);
    else if (n_ends == 3)
      add_cell(cells_, std::span(hex).first(5), q);
    else
      add_around_middle(hex, q);
  }

  /// Adds the half of a folded hexahedron at corners 0, i and j, less where these are ends.
  void add_half(const std::array<int, 8>& hex, int i, int j, int q) {
    std::array<int, 3> low = {0, i, j};
    const auto is_end = [&](int k) { return hex[k] == hex[k + 4]; };
    // An end is the first of two, and the last of all.
    for (int turn = 0; turn < 2 && (is_end(low[0]) || !is_end(low[2])); ++turn)
      std::ranges::rotate(low, low.begin() + 1);
    const auto [a, b, c] = std::array{hex[low[0]], hex[low[1]], hex[low[2]]};
    const int d = hex[low[0] + 4], e = hex[low[1] + 4], f = hex[low[2] + 4];
    if (c != f)
      add_cell(cells_, std::array{a, b, c, d, e, f}, q);
    else if (b != e)
      add_cell(cells_, std::array{a, d, e, b, c}, q);
    else
      add_cell(cells_, std::array{a, b, c, d}, q);
  }

  /// Adds cells between the middle of a hexahedron, whose top is folded, and its sides.
  void add_around_middle(const std::array<int, 8>& hex, int q) {
    const int middle = static_cast<int>(cells_.points.size());
    std::vector<int> corners(hex.begin(), hex.end());
    sort_unique(corners);
    cells_.points.push_back(middle_of(cells_.points, corners));
    std::vector<Quad> sides = {{5, 6, 4, 4}, {6, 7, 4, 4}};
    std::ranges::copy_if(cell_tables::kHexSides, std::back_inserter(sides),
                         [](const Quad& side) { return side[0] < 4; });
    for (const Quad& side : sides) {
      std::vector<int> seen;  // from the middle
      for (int k = 3; k >= 0; --k)
        if (hex[side[k]] != hex[side[(k + 1) % 4]]) seen.push_back(hex[side[k]]);
      seen.push_back(middle);
      if (seen.size() > 3) add_cell(cells_, seen, q);
    }
  }

  /// The quads of the body at which cells are not proven positive.
  std::vector<int> quads_of_poor_cells() const {
    std::vector<int> quads(n_solids(cells_), -1);
    parallel_each(quads.size(), [&](std::size_t i) {
      const Solid cell = solid_at(cells_, i);
      std::vector<Vec3> corners;
      for (const int v : cell.nodes) corners.push_back(cells_.points[v]);
      if (!is_positive(corners)) quads[i] = cell.volume;
    });
    std::erase(quads, -1);
    return quads;
  }

  std::vector<int> quads_of_crossings() const {
    std::vector<int> quads;
    std::vector<Quad> front = front_;
    std::vector<Triangle> triangles;
    split_folded(front, triangles);
    for (const int f : untangle(cells_.points, front, triangles)) quads.push_back(quad_of(f));
    return quads;
  }

  /// An edge between a quad with layers and one without.
  struct Rim {
    int a, b;
    std::vector<int> sides;  ///< the quads of rows there
  };

  const Mesh& body_;
  const std::vector<char>& has_layers_;
  std::span<const double> heights_;
  const double least_scale_;                ///< part of the wanted height below which layers end
  std::vector<std::vector<Spoke>> spokes_;  ///< by point
  std::vector<Place> at_;                   ///< by point
  std::vector<Rim> rims_;
  Mesh cells_;
  std::vector<Quad> front_;  ///< of the rest; those behind the flat ones are folded from the first corner
  std::vector<int> below_;   ///< quads of the body there
  std::size_t n_flat_ = 0;
};

}  // namespace

std::vector<int> fill_with_hexahedra(Mesh& body, const std::string& strategy, bool improve) {
  constexpr double kPart = 0.4, kGain = 1.02;
  constexpr std::size_t kThick = 2;  // hexahedra for each quad of the skin
  const auto filled = [](const Mesh& mesh) {
    double sum = 0;
    for (const auto& hex : mesh.hexahedra)
      sum += signed_volume(corners_of(mesh.points, hex)) * scaled_jacobian(corners_of(mesh.points, hex));
    return sum;
  };
  Mesh inside = body;
  place_hexahedra(body, strategy);
  if (body.hexahedra.size() < kThick * body.quads.size() && !open_faces(body).owners.empty()) {
    const std::vector<double> heights = {diagonal(inside.points)};
    const std::vector<char> all(inside.quads.size(), 1);
    LayerGrower grower(inside, all, heights, kPart);
    grower.grow();
    Mesh rest;
    rest.points = inside.points = grower.cells().points, rest.quads = grower.front();
    const std::vector<int> numbers = keep_used_points(rest);
    place_hexahedra(rest, strategy);
    for (std::size_t i = 0; i < n_solids(grower.cells()); ++i)
      if (const auto nodes = solid_at(grower.cells(), i).nodes; nodes.size() > 5) add_cell(inside, nodes, 0);
    add_cells(inside, rest, numbers, 0);
    const double wanted = kGain * filled(body);
    if (filled(inside) > wanted) {
      place_prisms(inside);
      Mesh plain = inside;  // repairs of poor cells take most of the time
      if (fill_around(plain, false).empty() && filled(plain) > wanted &&
          fill_around(inside, improve).empty() && filled(inside) > wanted)
        return body = std::move(inside), std::vector<int>{};
    }
  }
  place_prisms(body);
  return fill_around(body, improve);
}

std::vector<int> fill_with_layers(Mesh& body, const std::vector<char>& has_layers,
                                  std::span<const double> heights, const std::function<void(Mesh&)>& place,
                                  bool improve, GrownLayers& grown) {
  LayerGrower grower(body, has_layers, heights);
  while (true) {
    grower.grow();
    Mesh rest;
    rest.points = grower.cells().points, rest.quads = grower.front();
    const std::vector<int> points = keep_used_points(rest);
    place(rest);
    grower.split_folded(rest.quads, rest.triangles);
    std::vector<int> lost = fill_around(rest, improve);
    for (int& f : lost) f = grower.quad_of(f);
    if (grower.shrink(lost)) continue;
    if (!lost.empty()) return lost;
    grown = grower.told();
    const Mesh& layers = grower.cells();
    std::vector<int> own(layers.points.size());
    std::iota(own.begin(), own.end(), 0);
    body.points = layers.points;
    add_cells(body, rest, points, 0);
    add_cells(body, layers, own, 0);
    return {};
  }
}

}  // namespace delquad
