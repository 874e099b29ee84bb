// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_around.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/cancel.h"
#include "features/volume/fill_void.h"
#include "geometry/mesh/cell_shapes.h"

namespace delquad {

namespace {

/// A face of the skin or of a hexahedron or prism, counterclockwise seen from outside of the void.
struct OpenFace {
  std::array<int, 4> corners;  ///< the last is -1 for a triangle
  int owner;                   ///< face of the skin, quads first; -1 - i: cell i, hexahedra first
};

int n_of(const OpenFace& face) { return face.corners[3] < 0 ? 3 : 4; }

/// Returns the faces between the void and others.
std::vector<OpenFace> open_faces(const Mesh& body) {
  std::vector<OpenFace> all;
  for (const auto& q : body.quads) all.push_back({q, static_cast<int>(all.size())});
  for (const auto& [a, b, c] : body.triangles) all.push_back({{a, b, c, -1}, static_cast<int>(all.size())});
  for (int i = 0; i < static_cast<int>(n_solids(body)); ++i) {
    const Solid cell = solid_at(body, i);
    for (int k = 0; k < static_cast<int>(cell.shape->sides.size()); ++k) {
      std::array<int, 4> side = cell.side(k);
      std::reverse(side.begin(), side.end() - (side[3] < 0));
      all.push_back({side, -1 - i});
    }
  }
  std::vector<std::pair<std::array<int, 4>, int>> keys;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    keys.emplace_back(side_key(std::span(all[i].corners).first(n_of(all[i]))), i);
  }
  std::ranges::sort(keys);
  std::vector<int> open;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (i + 1 < keys.size() && keys[i].first == keys[i + 1].first)
      ++i;
    else
      open.push_back(keys[i].second);
  std::ranges::sort(open);
  std::vector<OpenFace> faces;
  for (const int i : open) faces.push_back(all[i]);
  std::ranges::stable_sort(faces, {}, [](const OpenFace& f) { return -n_of(f); });
  return faces;
}

/// Puts all cells into volume 0.
void number_volumes(Mesh& body) {
  for_each_shape(body, [](const SolidShape&, const auto& cells, std::vector<int>& volume_of) {
    volume_of.assign(cells.size(), 0);
  });
}

/// Removes cells, hexahedra first.
void drop_cells(Mesh& body, const std::vector<int>& cells) {
  std::vector<char> dropped(n_solids(body), 0);
  for (const int c : cells) dropped[c] = 1;
  std::size_t i = 0;
  for_each_shape(body, [&](const SolidShape&, auto& list, auto&) {
    std::erase_if(list, [&](const auto&) { return dropped[i++]; });
  });
  number_volumes(body);
}

/// Fills a void, and adds the cells to a body.
class Filler {
 public:
  Filler(Mesh& body, bool improve) : body_(body), improve_(improve) {}

  std::vector<int> fill() {
    for (;;) {
      check_cancelled();
      faces_ = open_faces(body_);
      if (faces_.empty()) return {};
      const Filling filling = fill_void(boundary_of_void(), improve_);
      if (filling.lost.empty()) {
        take_cells(filling);
        return {};
      }
      const std::vector<int> cells = cells_at(filling.lost);
      if (cells.empty()) return skin_at(filling.lost);
      drop_cells(body_, cells);
    }
  }

 private:
  VoidBoundary boundary_of_void() const {
    VoidBoundary boundary{body_.points, {}, {}, {}, std::vector<char>(body_.points.size(), 0)};
    for (const auto& [v, owner] : faces_)
      if (v[3] >= 0)
        boundary.quads.push_back(v);
      else
        boundary.triangles.push_back({v[0], v[1], v[2]});
    for (const auto& hex : body_.hexahedra) boundary.blocks.push_back(cell_of(hex));
    for (const auto& prism : body_.prisms) boundary.blocks.push_back(cell_of(prism));
    for (const auto& q : body_.quads)
      for (const int v : q) boundary.fixed[v] = 1;
    for (const auto& t : body_.triangles)
      for (const int v : t) boundary.fixed[v] = 1;
    return boundary;
  }

  /// Returns the cells with one of these faces, or else those that share a vertex with one.
  std::vector<int> cells_at(const std::vector<int>& faces) const {
    std::vector<int> owners;
    std::vector<char> at(body_.points.size(), 0);
    for (const int f : faces) {
      if (faces_[f].owner < 0) owners.push_back(-1 - faces_[f].owner);
      for (int k = 0; k < n_of(faces_[f]); ++k) at[faces_[f].corners[k]] = 1;
    }
    if (!owners.empty()) return owners;
    for (std::size_t i = 0; i < n_solids(body_); ++i)
      if (std::ranges::any_of(solid_at(body_, i).nodes, [&](int v) { return at[v]; }))
        owners.push_back(static_cast<int>(i));
    return owners;
  }

  std::vector<int> skin_at(const std::vector<int>& faces) const {
    std::vector<int> skin;
    for (const int f : faces)
      if (faces_[f].owner >= 0) skin.push_back(faces_[f].owner);
    return skin;
  }

  void take_cells(const Filling& filling) {
    body_.points = filling.points;
    body_.hexahedra.clear(), body_.prisms.clear();
    for (const Cell& cell : filling.cells) {
      const auto add = [&](auto& list) {
        list.emplace_back();
        std::copy_n(cell.begin(), list.back().size(), list.back().begin());
      };
      switch (n_corners(cell)) {
        case 8:
          add(body_.hexahedra);
          break;
        case 6:
          add(body_.prisms);
          break;
        case 5:
          add(body_.pyramids);
          break;
        default:
          add(body_.tetrahedra);
      }
    }
  }

  Mesh& body_;
  const bool improve_;
  std::vector<OpenFace> faces_;  ///< of the void, in the order of VoidBoundary
};

}  // namespace

std::vector<int> fill_around(Mesh& body, bool improve) {
  number_volumes(body);
  const std::vector<int> lost = Filler(body, improve).fill();
  number_volumes(body);
  return lost;
}

}  // namespace delquad
