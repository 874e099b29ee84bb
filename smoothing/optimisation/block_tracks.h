#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/sort_unique.h"
#include "geometry/mesh/element_blocks.h"
#include "smoothing/optimisation/track_optimisation.h"

namespace delquad {

/// The tracks of one block's vertices; those of other blocks, too, stay.
template <class Vec>
class BlockTracks final : public VertexTracks<Vec> {
 public:
  BlockTracks(VertexTracks<Vec>& whole, const std::vector<std::array<int, 4>>& quads,
              const ElementBlocks& blocks, std::size_t block)
      : whole_(whole), own_quads_(blocks[block]) {
    // Sorted, so that each has a number.
    for (const int q : own_quads_) vertices_.insert(vertices_.end(), quads[q].begin(), quads[q].end());
    sort_unique(vertices_);
    for (const int v : vertices_)
      moves_.push_back(blocks.owner(v) == static_cast<int>(block) && blocks.is_near(v));
    for (const int q : own_quads_) {
      auto& quad = quads_.emplace_back(quads[q]);
      for (int& v : quad) v = static_cast<int>(std::ranges::lower_bound(vertices_, v) - vertices_.begin());
    }
  }

  const std::vector<std::array<int, 4>>& quads() const { return quads_; }
  std::vector<Vec> points(const std::vector<Vec>& all) const {
    std::vector<Vec> own;
    for (const int v : vertices_) own.push_back(all[v]);
    return own;
  }
  void store(const std::vector<Vec>& own, std::vector<Vec>& all) const {
    for (std::size_t v = 0; v < own.size(); ++v)
      if (moves_[v]) all[vertices_[v]] = own[v];
  }

  Vec2 position(int v) const override { return whole_.position(vertices_[v]); }
  Vec put(int v, Vec2 position) override { return whole_.put(vertices_[v], position); }
  std::array<Vec, 2> axes(int v) const override {
    return moves_[v] ? whole_.axes(vertices_[v]) : std::array<Vec, 2>{};
  }
  double delta(const Vec& place, TrackHint& hint) const override { return whole_.delta(place, hint); }
  Vec arm(int quad, int side, TrackHint& hint) const override {
    return whole_.arm(own_quads_[quad], side, hint);
  }

 private:
  VertexTracks<Vec>& whole_;
  std::span<const int> own_quads_;
  std::vector<int> vertices_;  ///< of the whole mesh, sorted
  std::vector<char> moves_;
  std::vector<std::array<int, 4>> quads_;
};

}  // namespace delquad
