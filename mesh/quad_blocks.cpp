#include "mesh/quad_blocks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/box.h"

namespace delquad {

namespace {

/// Rings of elements around cuts that a later pass takes up, and how far in there is work to do.
constexpr int kBandRings = 7, kNearRings = 3;

/// Corners of an element: quads first, then triangles.
std::span<const int> corners_of(const QuadPatch& mesh, int element) {
  const auto n = static_cast<int>(mesh.quads.size());
  return element < n ? std::span<const int>(mesh.quads[element])
                     : std::span<const int>(mesh.triangles[element - n]);
}

/// Place along a Hilbert curve through 2^16 times 2^16 cells.
std::uint32_t hilbert_place(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0;
  for (std::uint32_t side = 1U << 15; side > 0; side /= 2) {
    const std::uint32_t right = (x & side) != 0, up = (y & side) != 0;
    place = 4 * place + ((3 * right) ^ up);
    if (up == 0) {
      if (right != 0) x = ~x, y = ~y;
      std::swap(x, y);
    }
  }
  return place;
}

/// Maps the plane to the curve's cells; `turned`: so that cuts cross those of the other one.
class CurveFrame {
 public:
  CurveFrame(const std::vector<Vec2>& points, bool turned) : turned_(turned) {
    Box<Vec2> box{turn(points[0]), turn(points[0])};
    for (const Vec2 p : points) box.add(turn(p));
    const Vec2 size = box.size();
    // In the turned frame the middle of the box is no corner of large cells.
    constexpr double kShift = 0.3;
    low_ = turned ? box.low - kShift * size : box.low;
    cells_ = 65535 / ((turned ? 1 + kShift : 1) * std::max({size.x, size.y, 1e-300}));
  }
  std::uint32_t place(Vec2 p) const {
    const Vec2 at = cells_ * (turn(p) - low_);
    return hilbert_place(cell(at.x), cell(at.y));
  }

 private:
  Vec2 turn(Vec2 p) const { return turned_ ? Vec2{0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y} : p; }
  static std::uint32_t cell(double x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0, 65535.0)); }

  bool turned_;
  Vec2 low_;
  double cells_;
};

/// Sorts by keys[i], ties in their order, in two passes of 16 bits.
void sort_by_key(std::vector<int>& items, const std::vector<std::uint32_t>& keys) {
  std::vector<int> other(items.size());
  for (const int shift : {0, 16}) {
    std::vector<std::size_t> first((1U << 16) + 1, 0);
    const auto digit = [&](int i) { return keys[i] >> shift & 0xFFFFU; };
    for (const int i : items) ++first[digit(i) + 1];
    for (std::size_t d = 0; d < 1U << 16; ++d) first[d + 1] += first[d];
    for (const int i : items) other[first[digit(i)]++] = i;
    items.swap(other);
  }
}

/// Makes the mesh of one block.
class BlockCutter {
 public:
  /// `place`: of the whole's vertices in the block that owns them; -1 at first.
  BlockCutter(const QuadPatch& whole, std::span<const int> elements, int block, const std::vector<int>& owner,
              std::vector<int>& place)
      : whole_(whole), elements_(elements), block_(block), owner_(owner), place_(place) {}

  QuadBlock cut();

 private:
  /// A corner at a held vertex, with the ends of its two sides.
  struct HeldCorner {
    int vertex, next, before, corner;
  };
  void add_boundary();
  void add_held();
  int add_point(int v);

  const QuadPatch& whole_;
  std::span<const int> elements_;
  int block_;
  const std::vector<int>& owner_;
  std::vector<int>& place_;
  std::vector<HeldCorner> held_;
  std::vector<int> copy_;  ///< by 4 * place of the element + corner: the point, where the vertex is held
  QuadBlock result_;
};

int BlockCutter::add_point(int v) {
  result_.mesh.points.push_back(whole_.points[v]);
  return static_cast<int>(result_.mesh.points.size()) - 1;
}

void BlockCutter::add_boundary() {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto corners = corners_of(whole_, elements_[i]);
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const int v = corners[k];
      if (owner_[v] != block_) {
        held_.push_back({v, corners[(k + 1) % n], corners[(k + n - 1) % n], static_cast<int>(4 * i + k)});
      } else if (v < whole_.n_boundary && place_[v] < 0) {
        place_[v] = add_point(v);
        result_.whole.push_back(v);
      }
    }
  }
  result_.first_held = static_cast<int>(result_.mesh.points.size());
}

/// A point for each fan: corners that follow each other across a side belong to one.
void BlockCutter::add_held() {
  copy_.assign(4 * elements_.size(), -1);
  std::ranges::sort(held_, {}, [](const HeldCorner& c) { return std::pair(c.vertex, c.corner); });
  for (auto begin = held_.begin(); begin != held_.end();) {
    const auto end = std::find_if(begin, held_.end(), [&](const auto& c) { return c.vertex != begin->vertex; });
    for (auto c = begin; c != end; ++c) {
      if (copy_[c->corner] >= 0) continue;
      const int point = add_point(c->vertex);
      result_.whole.push_back(c->vertex);
      const auto walk = [&](int HeldCorner::*to, int HeldCorner::*from) {
        for (auto at = c; at != end;) {
          copy_[at->corner] = point;
          const int side = (*at).*to;
          at = std::find_if(begin, end, [&](const HeldCorner& other) {
            return other.*from == side && copy_[other.corner] < 0;
          });
        }
      };
      walk(&HeldCorner::before, &HeldCorner::next);
      walk(&HeldCorner::next, &HeldCorner::before);
    }
    begin = end;
  }
}

QuadBlock BlockCutter::cut() {
  add_boundary();
  add_held();
  result_.mesh.n_boundary = static_cast<int>(result_.mesh.points.size());
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const auto corners = corners_of(whole_, elements_[i]);
    std::array<int, 4> points;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int v = corners[k];
      points[k] = copy_[4 * i + k];
      if (points[k] >= 0) continue;
      if (place_[v] < 0) place_[v] = add_point(v);
      points[k] = place_[v];
    }
    if (corners.size() == 4)
      result_.mesh.quads.push_back(points);
    else
      result_.mesh.triangles.push_back({points[0], points[1], points[2]});
  }
  return std::move(result_);
}

}  // namespace

bool QuadBlocks::has_all_points() const {
  const auto n = static_cast<int>(mesh_.points.size());
  for (int e = 0; e < n_elements(); ++e)
    for (const int v : corners_of(mesh_, e))
      if (v < 0 || v >= n) return false;
  return mesh_.n_boundary <= n;
}

/// With the vertices of `rings` rings of elements around.
std::vector<char> QuadBlocks::grown(std::vector<char> vertices, int rings) const {
  std::vector<char> met(n_elements(), 0);
  std::vector<std::vector<int>> found((met.size() + 1023) / 1024);
  for (int ring = 0; ring < rings; ++ring) {
    parallel_ranges(met.size(), [&](std::size_t begin, std::size_t end) {
      std::vector<int>& here = found[begin / 1024];
      here.clear();
      for (std::size_t e = begin; e < end; ++e)
        if (!met[e] && std::ranges::any_of(corners_of(mesh_, static_cast<int>(e)),
                                           [&](int v) { return vertices[v] != 0; }))
          met[e] = 1, here.push_back(static_cast<int>(e));
    });
    for (const auto& here : found)
      for (const int e : here)
        for (const int v : corners_of(mesh_, e)) vertices[v] = 1;
  }
  return vertices;
}

/// The elements at these vertices (empty: all), along the curve.
std::vector<int> QuadBlocks::ordered_elements(const std::vector<char>& around, bool turned) const {
  const CurveFrame frame(mesh_.points, turned);
  std::vector<std::uint32_t> keys(n_elements());
  std::vector<char> is_in(keys.size());
  parallel_ranges(keys.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto corners = corners_of(mesh_, static_cast<int>(e));
      is_in[e] = around.empty() || std::ranges::any_of(corners, [&](int v) { return around[v] != 0; });
      if (is_in[e]) keys[e] = frame.place(0.5 * (mesh_.points[corners[0]] + mesh_.points[corners[2]]));
    }
  });
  std::vector<int> elements;
  for (std::size_t e = 0; e < is_in.size(); ++e)
    if (is_in[e]) elements.push_back(static_cast<int>(e));
  sort_by_key(elements, keys);
  return elements;
}

void QuadBlocks::find_owners() {
  constexpr int kNobody = -2;
  owner_.assign(mesh_.points.size(), kNobody);
  taken_.assign(n_elements(), 0);
  const auto claim = [&](int e, int block) {
    for (const int v : corners_of(mesh_, e)) owner_[v] = owner_[v] == kNobody || owner_[v] == block ? block : -1;
  };
  for (std::size_t b = 0; b < own_.size(); ++b)
    for (const int e : own_[b]) taken_[e] = 1, claim(e, static_cast<int>(b));
  for (int e = 0; e < n_elements(); ++e)
    if (!taken_[e]) claim(e, -1);
}

std::vector<QuadBlock> QuadBlocks::cut() {
  find_owners();
  std::vector<int> place(mesh_.points.size(), -1);
  std::vector<QuadBlock> blocks(own_.size());
  parallel_for(own_.size(), [&](std::size_t b) {
    blocks[b] = BlockCutter(mesh_, own_[b], static_cast<int>(b), owner_, place).cut();
  });
  if (pass_ == Pass::kFirst) {
    left_.assign(mesh_.points.size(), 0);
    for (std::size_t v = 0; v < left_.size(); ++v) left_[v] = owner_[v] == -1;
    return blocks;
  }
  const std::vector<char> near = grown(left_, kNearRings);
  for (QuadBlock& block : blocks) {
    block.near.resize(block.mesh.points.size());
    for (std::size_t i = 0; i < block.whole.size(); ++i) block.near[i] = near[block.whole[i]];
  }
  for (std::size_t v = mesh_.n_boundary; v < place.size(); ++v)
    if (owner_[v] >= 0) blocks[owner_[v]].near[place[v]] = near[v];
  for (std::size_t v = 0; v < left_.size(); ++v) left_[v] &= owner_[v] == -1;
  return blocks;
}

std::vector<QuadBlock> QuadBlocks::next() {
  pass_ = static_cast<Pass>(static_cast<int>(pass_) + 1);
  if (pass_ == Pass::kFirst && (n_elements() < 2 * kBlockElements || !has_all_points())) {
    pass_ = Pass::kDone;
    std::vector<QuadBlock> blocks(1);
    blocks[0].first_held = mesh_.n_boundary;
    blocks[0].mesh = std::move(mesh_);
    own_.clear();
    return blocks;
  }
  const bool first = pass_ == Pass::kFirst;
  if (pass_ > Pass::kLast || (!first && std::ranges::find(left_, 1) == left_.end())) return {};
  const std::vector<int> elements =
      ordered_elements(first ? std::vector<char>{} : grown(left_, kBandRings), !first);
  const std::size_t n = pass_ == Pass::kLast ? 1 : std::max<std::size_t>(elements.size() / kBlockElements, 1);
  own_.clear();
  for (std::size_t b = 0; b < n; ++b)
    own_.emplace_back(elements.begin() + static_cast<std::ptrdiff_t>(b * elements.size() / n),
                      elements.begin() + static_cast<std::ptrdiff_t>((b + 1) * elements.size() / n));
  return cut();
}

void QuadBlocks::put_back(std::vector<QuadBlock> blocks) {
  if (own_.empty()) {
    mesh_ = std::move(blocks.at(0).mesh);
    return;
  }
  QuadPatch whole;
  whole.n_boundary = mesh_.n_boundary;
  std::vector<int> number(mesh_.points.size(), -1);
  std::vector<char> left;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (static_cast<int>(v) >= mesh_.n_boundary && owner_[v] >= 0) continue;
    number[v] = static_cast<int>(whole.points.size());
    whole.points.push_back(mesh_.points[v]);
    left.push_back(left_[v]);
  }
  const auto add = [](auto& elements, auto element, const std::vector<int>& numbers) {
    for (int& v : element) v = numbers[v];
    elements.push_back(element);
  };
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    if (!taken_[q]) add(whole.quads, mesh_.quads[q], number);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (!taken_[mesh_.quads.size() + t]) add(whole.triangles, mesh_.triangles[t], number);
  for (const QuadBlock& block : blocks) {
    std::vector<int> numbers;
    for (const int v : block.whole) numbers.push_back(number[v]);
    for (std::size_t i = numbers.size(); i < block.mesh.points.size(); ++i) {
      numbers.push_back(static_cast<int>(whole.points.size()));
      whole.points.push_back(block.mesh.points[i]);
    }
    for (const auto& quad : block.mesh.quads) add(whole.quads, quad, numbers);
    for (const auto& triangle : block.mesh.triangles) add(whole.triangles, triangle, numbers);
  }
  left.resize(whole.points.size(), 0);
  left_ = std::move(left);
  mesh_ = std::move(whole);
}

}  // namespace delquad
