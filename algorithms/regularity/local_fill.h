// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/regularity/fill_trial.h"
#include "algorithms/regularity/patch_work.h"

// This header fills cavities on a copy beside their patch, and puts fills in place. Stage Q across curves
// uses it.

namespace delquad::across {

/// Rings of quads around changed polygons and curves that are relocated.
inline constexpr int kMovedRings = 2;

/// A cavity filled on its own mesh, in the plane of its patch, with the elements around all moving vertices.
class LocalFill {
 public:
  /// Throws std::invalid_argument if two vertices would share a second edge.
  LocalFill(PatchWork& work, const Cavity& cavity, const Rim& rim, const PatternMesh& fill)
      : whole_(work.mesh), cavity_(cavity), rim_(rim) {
    find_moving();
    FillTrial there(work.mesh, work.relocation);
    there.region = moving_;
    for (const int v : cavity_.vertices())
      if (cavity_.is_inside(v)) there.region.push_back(v);
    there.measure_before();
    before = there.before;
    Marks met;
    met.begin(whole_.element_slots());
    for_each_element_around(whole_, there.region, met, [&](int e) { elements_.push_back(e); });
    const int first_held = add_vertices();
    add_elements(fill);
    mesh.emplace(local_, first_held);
    relocation.emplace(*mesh, *work.patch.size);
    limit_relocation(*relocation);
    for (const int v : moving_)
      if (const auto at = number_.find(v); at != number_.end()) region.push_back(at->second);
  }

  std::optional<QuadTopology> mesh;
  std::optional<QuadRelocation> relocation;
  std::vector<int> global;         ///< vertex of the patch for each vertex here; negative: new
  std::vector<int> corner;         ///< vertex here for each vertex of the rim
  std::vector<int> region;         ///< moving vertices
  FillTrial::Quality before;       ///< quality before the fill
  int first_fill = 0, n_fill = 0;  ///< first quad of the fill, and its number of quads

 private:
  void find_moving() {
    Marks met;
    met.begin(whole_.vertex_slots());
    const auto move_around = [&](int at) {
      whole_.for_each_out(at, [&](int h) {
        const int e = QuadTopology::element(h);
        for (int k = 0; k < 4; ++k)
          if (const int v = whole_.corner(e, k); v >= 0 && !cavity_.is_inside(v) && met.meet(v))
            moving_.push_back(v);
      });
    };
    for (const int h : cavity_.rim()) move_around(whole_.origin(h));
    for (const auto& [v, at] : rim_.moved) move_around(v);
    for (int ring = 1; ring < kMovedRings; ++ring)
      for (std::size_t i = 0, n = moving_.size(); i < n; ++i) move_around(moving_[i]);
  }

  int add(int v, Vec2 at) {
    global.push_back(v);
    local_.points.push_back(at);
    return static_cast<int>(global.size()) - 1;
  }

  /// Adds vertices of the boundary and new ones first, then held vertices, which have elements elsewhere.
  /// Returns the first held one.
  int add_vertices() {
    std::map<int, int> in_elements;
    for (const int e : elements_)
      for (int k = 0; k < 4; ++k)
        if (const int v = whole_.corner(e, k); v >= 0) ++in_elements[v];
    const std::set<int> on_rim(rim_.vertex.begin(), rim_.vertex.end());
    const auto add_where = [&](const auto& is_next) {
      for (const auto& [v, n] : in_elements) {
        const bool stays = on_rim.contains(v) || !(cavity_.is_inside(v) || rim_.gone.contains(v));
        if (!stays || !is_next(v, n)) continue;
        const auto moved = rim_.moved.find(v);
        number_[v] = add(v, moved == rim_.moved.end() ? whole_.point(v) : moved->second);
      }
    };
    add_where([&](int v, int) { return whole_.on_boundary(v); });
    for (std::size_t i = 0; i < rim_.vertex.size(); ++i)
      corner.push_back(rim_.vertex[i] >= 0 ? -1 : add(-1, rim_.outline.places[i]));
    const int first_held = static_cast<int>(global.size());
    add_where([&](int v, int n) { return !whole_.on_boundary(v) && n < whole_.valence(v); });
    local_.n_boundary = static_cast<int>(global.size());
    add_where([&](int v, int n) { return !whole_.on_boundary(v) && n == whole_.valence(v); });
    for (std::size_t i = 0; i < rim_.vertex.size(); ++i)
      if (rim_.vertex[i] >= 0) corner[i] = number_.at(rim_.vertex[i]);
    return first_held;
  }

  void add_elements(const PatternMesh& fill) {
    for (const int e : elements_) {
      if (cavity_.has(e)) continue;
      std::array<int, 4> corners{};
      for (int k = 0; k < 4; ++k)
        if (const int v = whole_.corner(e, k); v >= 0) corners[k] = number_.at(v);
      if (whole_.is_quad(e))
        local_.quads.push_back(corners);
      else
        local_.triangles.push_back({corners[0], corners[1], corners[2]});
    }
    std::vector<int> vertex = corner;
    for (const Vec2 at : fill.inside) vertex.push_back(region.emplace_back(add(-1, at)));
    first_fill = static_cast<int>(local_.quads.size());
    n_fill = static_cast<int>(fill.quads.size());
    for (auto quad : fill.quads) {
      for (int& v : quad) v = vertex[v];
      local_.quads.push_back(quad);
    }
  }

  const QuadTopology& whole_;
  const Cavity& cavity_;
  const Rim& rim_;
  std::vector<int> moving_, elements_;  ///< of the patch
  std::map<int, int> number_;           ///< vertex here for each vertex of the patch
  QuadPatch local_;
};

/// Moves a fill into its patch when finish() is called; boundary points keep their order.
class FillTaking {
 public:
  FillTaking(PatchWork& work, const Cavity& cavity, const LocalFill& fill, const Rim& rim)
      : number(work.patch.mesh.points.size(), -1),
        of_local(fill.global.size(), -1),
        work_(work),
        cavity_(cavity),
        fill_(fill) {
    add_boundary(rim);
    add_inside();
    add_elements();
  }

  void finish(std::span<const Change> changes) {
    // Renumbers the edges of changed curves along each of them.
    for (const Change& change : changes) {
      const auto is_on = [&](const CurveEdge& e) { return e.curve == change.curve; };
      const auto n = static_cast<int>(std::ranges::count_if(edges_, is_on));
      int k = 0;
      for (CurveEdge& e : edges_)
        if (is_on(e)) e.index = e.forward ? k++ : n - 1 - k++;
    }
    work_.patch.mesh = std::move(made_);
    work_.patch.edges = std::move(edges_);
    work_.patch.changed = true;
  }

  std::vector<int> number, of_local;  ///< new numbers of vertices

 private:
  int add(Vec2 at) {
    made_.points.push_back(at);
    return static_cast<int>(made_.points.size()) - 1;
  }

  void add_boundary(const Rim& rim) {
    std::map<int, std::vector<int>> after;  // new nodes by their previous boundary point
    for (std::size_t i = 0, last = 0; i < rim.vertex.size(); ++i) {
      if (rim.vertex[i] >= 0)
        last = i;
      else
        after[rim.vertex[last]].push_back(fill_.corner[i]);
    }
    const QuadPatch& old = work_.patch.mesh;
    for (int v = 0; v < old.n_boundary; ++v) {
      if (rim.gone.contains(v)) continue;
      number[v] = add(old.points[v]);
      for (const int local : after[v]) of_local[local] = add(fill_.mesh->point(local));
      edges_.insert(edges_.end(), 1 + after[v].size(), work_.patch.edges[v]);
    }
    made_.n_boundary = static_cast<int>(made_.points.size());
  }

  void add_inside() {
    const QuadPatch& old = work_.patch.mesh;
    for (int v = old.n_boundary; v < static_cast<int>(old.points.size()); ++v)
      if (!cavity_.is_inside(v)) number[v] = add(old.points[v]);
    for (std::size_t local = 0; local < fill_.global.size(); ++local) {
      const Vec2 at = fill_.mesh->point(static_cast<int>(local));
      if (fill_.global[local] >= 0) {
        of_local[local] = number[fill_.global[local]];
        made_.points[of_local[local]] = at;
      } else if (of_local[local] < 0) {
        of_local[local] = add(at);
      }
    }
  }

  void add_elements() {
    const QuadPatch& old = work_.patch.mesh;
    for (std::size_t q = 0; q < old.quads.size(); ++q) {
      if (cavity_.has(static_cast<int>(q))) continue;
      auto& quad = made_.quads.emplace_back(old.quads[q]);
      for (int& v : quad) v = number[v];
    }
    for (int e = fill_.first_fill; e < fill_.first_fill + fill_.n_fill; ++e) {
      auto& quad = made_.quads.emplace_back();
      for (int k = 0; k < 4; ++k) quad[k] = of_local[fill_.mesh->corner(e, k)];
    }
    made_.triangles = old.triangles;
    for (auto& triangle : made_.triangles)
      for (int& v : triangle) v = number[v];
  }

  PatchWork& work_;
  const Cavity& cavity_;
  const LocalFill& fill_;
  QuadPatch made_;
  std::vector<CurveEdge> edges_;
};

}  // namespace delquad::across
