// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/sort_unique.h"
#include "features/embedded/imprint.h"
#include "geometry/mesh/double_nodes.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {
namespace {

/// Opens the triangulation of a model. Corner 3 t + k is the k-th one of triangle t.
class CrackOpener {
 public:
  CrackOpener(SurfaceModel& model, const std::map<int, int>& face_of_crack)
      : mesh_(model.fine), face_of_crack_(face_of_crack), sides_(sorted_half_edges(mesh_)) {
    for (const auto& triangle : mesh_.triangles) was_.insert(was_.end(), triangle.begin(), triangle.end());
    node_ = was_;
    std::vector<char> on_crack(mesh_.points.size(), 0);
    std::set<std::pair<int, int>> edges;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      const auto& [a, b] = mesh_.lines[l];
      if (!face_of_crack_.contains(mesh_.line_curve[l])) continue;
      on_crack[a] = on_crack[b] = 1;
      edges.insert(std::minmax(a, b));
    }
    DisjointSets joined(was_.size());
    for_each_edge(std::span<const HalfEdge>(sides_), [&](std::span<const HalfEdge> edge) {
      const int lo = edge[0].lo, hi = edge[0].hi;
      if ((on_crack[lo] || on_crack[hi]) && !edges.contains({lo, hi}))
        for (const HalfEdge& other : edge.subspan(1))
          for (const int v : {lo, hi}) joined.join(corner(edge[0].element, v), corner(other.element, v));
    });
    std::vector<char> opens;
    for (const int v : was_) opens.push_back(on_crack[v]);
    double_nodes(joined, opens, node_, mesh_.points);
  }

  /// Moves the lines to the new nodes. Returns the second lip of each crack.
  std::map<int, int> redraw() {
    std::map<int, int> lips;
    for (std::size_t l = 0, n = mesh_.lines.size(); l < n; ++l) {
      const std::array<int, 2> line = mesh_.lines[l];
      const auto edge = sides_of_edge(sides_, line[0], line[1]);
      const auto ends = [&](const HalfEdge& side) {
        return std::array{node_[corner(side.element, line[0])], node_[corner(side.element, line[1])]};
      };
      const bool opens = face_of_crack_.contains(mesh_.line_curve[l]) && edge.size() == 2;
      const std::size_t left = opens && edge[0].run() != line ? 1 : 0;
      mesh_.lines[l] = ends(edge[left]);
      if (opens) add_lip_line(mesh_, mesh_.line_curve[l], ends(edge[1 - left]), lips);
    }
    return lips;
  }

  void renumber(std::vector<int>& corners, std::vector<FlatPatch>& maps) {
    const std::set<int> were(corners.begin(), corners.end());
    for (std::size_t s = 0; s < node_.size(); ++s) {
      mesh_.triangles[s / 3][s % 3] = node_[s];
      if (node_[s] != was_[s] && were.contains(was_[s])) corners.push_back(node_[s]);
    }
    sort_unique(corners);
    for (FlatPatch& map : maps)
      for (std::size_t t = 0; t < map.fine_triangle.size(); ++t)
        for (int k = 0; k < 3; ++k)
          map.fine_node[map.flat.triangles[t][k]] = mesh_.triangles[map.fine_triangle[t]][k];
  }

 private:
  int corner(int triangle, int v) const {
    const int* first = &was_[3 * static_cast<std::size_t>(triangle)];
    return 3 * triangle + static_cast<int>(std::find(first, first + 3, v) - first);
  }

  Mesh& mesh_;
  const std::map<int, int>& face_of_crack_;
  std::vector<HalfEdge> sides_;
  std::vector<int> was_, node_;  ///< of each corner, before and now
};

/// The second lips of cracks, from a number of curve on, lie where the first ones do.
class LipProjector final : public SurfaceProjector {
 public:
  LipProjector(std::shared_ptr<const SurfaceProjector> base, int first_lip,
               std::vector<std::array<int, 2>> lips)
      : base_(std::move(base)), first_lip_(first_lip), lips_(std::move(lips)) {}
  Vec3 to_face(int face, const Vec3& x) const override { return base_->to_face(face, x); }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    return base_->to_curve(curve < first_lip_ ? curve : lips_[curve - first_lip_][0], x);
  }
  PrincipalCurvatures curvatures(int face, const Vec3& x) const override {
    return base_->curvatures(face, x);
  }

 private:
  std::shared_ptr<const SurfaceProjector> base_;
  int first_lip_;
  std::vector<std::array<int, 2>> lips_;
};

}  // namespace

void open_cracks(SurfaceModel& model, std::vector<FlatPatch>& maps) {
  std::map<int, int> face_of_crack;
  for (const EmbeddedCurve& c : model.embedded)
    if (c.is_crack) face_of_crack[c.curve] = c.face;
  if (face_of_crack.empty()) return;
  const int first_lip = static_cast<int>(model.fine.curves.size());
  CrackOpener opener(model, face_of_crack);
  for (const auto& [crack, lip] : opener.redraw()) model.lips.push_back({crack, lip});
  opener.renumber(model.corners, maps);
  std::ranges::sort(model.lips, {}, [](const auto& both) { return both[1]; });
  std::erase_if(model.embedded, &EmbeddedCurve::is_crack);
  if (model.projector)
    model.projector = std::make_shared<LipProjector>(model.projector, first_lip, model.lips);
}

}  // namespace delquad
