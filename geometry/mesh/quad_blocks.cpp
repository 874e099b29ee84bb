// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/quad_blocks.h"

#include <algorithm>
#include <array>
#include <span>

namespace delquad {

namespace {

/// Makes the mesh of one block.
class BlockCutter {
 public:
  /// `place` has the index of each vertex of the whole in the block that owns it; -1 at first.
  BlockCutter(const QuadPatch& whole, const ElementBlocks& blocks, std::size_t block, std::vector<int>& place)
      : whole_(whole),
        all_{whole.quads, whole.triangles},
        blocks_(blocks),
        elements_(blocks[block]),
        block_(static_cast<int>(block)),
        place_(place) {}

  QuadBlock cut() {
    add_boundary();
    add_held();
    result_.mesh.n_boundary = static_cast<int>(result_.mesh.points.size());
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto corners = all_.corners(elements_[i]);
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

 private:
  /// A corner at a held vertex, with the ends of its two sides.
  struct HeldCorner {
    int vertex, next, before, corner;
  };

  void add_boundary() {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto corners = all_.corners(elements_[i]);
      const std::size_t n = corners.size();
      for (std::size_t k = 0; k < n; ++k) {
        const int v = corners[k];
        if (blocks_.owner(v) != block_) {
          held_.push_back({v, corners[(k + 1) % n], corners[(k + n - 1) % n], static_cast<int>(4 * i + k)});
        } else if (v < whole_.n_boundary && place_[v] < 0) {
          place_[v] = add_point(v);
          result_.whole.push_back(v);
        }
      }
    }
    result_.first_held = static_cast<int>(result_.mesh.points.size());
  }

  /// Adds a held point for each fan of corners that follow each other across sides.
  void add_held() {
    copy_.assign(4 * elements_.size(), -1);
    std::ranges::sort(held_, {}, [](const HeldCorner& c) { return std::pair(c.vertex, c.corner); });
    for (auto begin = held_.begin(); begin != held_.end();) {
      const auto end =
          std::find_if(begin, held_.end(), [&](const auto& c) { return c.vertex != begin->vertex; });
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

  int add_point(int v) {
    result_.mesh.points.push_back(whole_.points[v]);
    return static_cast<int>(result_.mesh.points.size()) - 1;
  }

  const QuadPatch& whole_;
  Elements all_;
  const ElementBlocks& blocks_;
  std::span<const int> elements_;
  int block_;
  std::vector<int>& place_;
  std::vector<HeldCorner> held_;
  std::vector<int> copy_;  ///< point of each held corner, by 4 * place of the element + corner
  QuadBlock result_;
};

}  // namespace

bool QuadBlocks::has_all_points() const {
  const auto n = static_cast<int>(mesh_.points.size());
  const auto has = [&](const auto& element) {
    return std::ranges::all_of(element, [&](int v) { return v >= 0 && v < n; });
  };
  return mesh_.n_boundary <= n && std::ranges::all_of(mesh_.quads, has) &&
         std::ranges::all_of(mesh_.triangles, has);
}

std::vector<QuadBlock> QuadBlocks::next() {
  const Elements elements{mesh_.quads, mesh_.triangles};
  if (refused_ || (!begun_ && !has_all_points())) {
    if (std::exchange(refused_, true)) return {};
  } else if (!blocks_.next(elements, mesh_.points)) {
    return {};
  }
  begun_ = true;
  std::vector<QuadBlock> blocks(blocks_.size());
  if (refused_ || blocks_.is_whole()) {
    blocks.resize(1);
    blocks[0].first_held = mesh_.n_boundary;
    blocks[0].mesh = std::move(mesh_);
    return blocks;
  }
  std::vector<int> place(mesh_.points.size(), -1);
  parallel_for(blocks.size(), [&](std::size_t b) {
    QuadBlock& block = blocks[b] = BlockCutter(mesh_, blocks_, b, place).cut();
    block.near.resize(block.mesh.points.size());
    for (std::size_t i = 0; i < block.whole.size(); ++i) block.near[i] = blocks_.is_near(block.whole[i]);
  });
  parallel_ranges(place.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (static_cast<int>(v) >= mesh_.n_boundary && blocks_.owner(v) >= 0)
        blocks[blocks_.owner(v)].near[place[v]] = blocks_.is_near(v);
  });
  return blocks;
}

void QuadBlocks::put_back(std::vector<QuadBlock> blocks) {
  if (refused_ || blocks_.is_whole()) {
    mesh_ = std::move(blocks.at(0).mesh);
    return;
  }
  QuadPatch whole;
  whole.n_boundary = mesh_.n_boundary;
  std::vector<int> number(mesh_.points.size(), -1);
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (static_cast<int>(v) >= mesh_.n_boundary && blocks_.owner(v) >= 0) continue;
    number[v] = static_cast<int>(whole.points.size());
    whole.points.push_back(mesh_.points[v]);
  }
  const auto add = [](auto& elements, auto element, const std::vector<int>& numbers) {
    for (int& v : element) v = numbers[v];
    elements.push_back(element);
  };
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    if (!blocks_.has_element(q)) add(whole.quads, mesh_.quads[q], number);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    if (!blocks_.has_element(mesh_.quads.size() + t)) add(whole.triangles, mesh_.triangles[t], number);
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
  blocks_.renumber(number, whole.points.size());
  mesh_ = std::move(whole);
}

}  // namespace delquad
