// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/crosses/size_aware.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "algorithms/insertion/frontal_mesher.h"
#include "base/activity.h"
#include "base/disjoint_sets.h"
#include "base/parallel.h"
#include "delquad/extend.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/surface/compound.h"

namespace delquad {
namespace {

/// Patches that hang together by seams, so that their fields are one.
struct FieldGroup {
  std::vector<int> patches;      ///< indices into MeshingSetup::patches, ascending
  std::vector<FieldSeam> seams;  ///< with indices into `patches`
};

/// How much fields are drawn to the edges of curves at which two faces join smoothly, and of cuts, see
/// CrossDiffusion; measured, see docs/algorithms.md.
constexpr double kSmoothAlignment = 1, kCutAlignment = 0.03;

/// Returns for each curve how strongly fields are drawn to it, and nothing if fields are given there.
std::vector<std::optional<double>> alignments(const MeshingSetup& prepared) {
  std::vector<std::optional<double>> of_curve(prepared.boundary.curves.size());
  if (!prepared.surface) return of_curve;
  const std::vector<char> smooth = tangent_curves(prepared.surface->model);
  for (std::size_t c = 0; c < of_curve.size() && c < smooth.size(); ++c)
    if (smooth[c]) of_curve[c] = kSmoothAlignment;
  for (const SurfaceCut& cut : prepared.surface->cuts) of_curve[cut.curve] = kCutAlignment;
  return of_curve;
}

struct SharedEdge {
  std::vector<FieldSeam::Side> sides;
  std::vector<int> from;  ///< the node at which each begins
};

/// Edges of curves where fields are not given, by curve and nodes.
std::map<std::array<int, 3>, SharedEdge> shared_edges(
    const MeshingSetup& prepared, const std::vector<std::shared_ptr<const BackgroundMesh>>& backgrounds,
    const std::vector<std::optional<double>>& alignment) {
  std::map<std::array<int, 3>, SharedEdge> shared;
  for (int i = 0; i < static_cast<int>(backgrounds.size()); ++i) {
    const PatchBoundary& boundary = prepared.patches[i].boundary;
    std::vector<int> curve_from(boundary.points.size(), -1);
    for (std::size_t e = 0; e < boundary.edges.size(); ++e)
      curve_from[boundary.edges[e][0]] = boundary.edge_curve[e];
    const TriPatch& tri = backgrounds[i]->triangles();
    for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        if (tri.neighbours[t][k] >= 0) continue;
        const int from = tri.triangles[t][(k + 1) % 3], to = tri.triangles[t][(k + 2) % 3];
        const int curve = curve_from[from];
        if (curve < 0 || !alignment[curve]) continue;
        const auto [low, high] = std::minmax(boundary.point_node[from], boundary.point_node[to]);
        SharedEdge& edge = shared[{curve, low, high}];
        edge.sides.push_back({i, t, k});
        edge.from.push_back(boundary.point_node[from]);
      }
  }
  return shared;
}

/// All patches, in groups. Seams are the edges of a surface's cuts, and of curves at which two faces join
/// smoothly: features, the outline and curves of planar domains are none. `backgrounds`: of each patch, made
/// from its boundary, whose edges are all there.
std::vector<FieldGroup> field_groups(const MeshingSetup& prepared,
                                     const std::vector<std::shared_ptr<const BackgroundMesh>>& backgrounds) {
  const std::vector<std::optional<double>> alignment = alignments(prepared);
  std::vector<FieldSeam> seams;
  DisjointSets joined(backgrounds.size());
  for (const auto& [key, edge] : shared_edges(prepared, backgrounds, alignment)) {
    if (edge.sides.size() != 2 || edge.from[0] == edge.from[1]) continue;
    seams.push_back({{edge.sides[0], edge.sides[1]}, *alignment[key[0]]});
    joined.join(edge.sides[0].patch, edge.sides[1].patch);
  }

  std::vector<FieldGroup> groups;
  std::vector<int> group_of(joined.size()), place(joined.size());
  for (int i = 0; i < std::ssize(group_of); ++i) {
    const int root = joined.root(i);
    if (root == i) groups.emplace_back();
    group_of[i] = root == i ? static_cast<int>(groups.size()) - 1 : group_of[root];
    FieldGroup& group = groups[group_of[i]];
    place[i] = static_cast<int>(group.patches.size());
    group.patches.push_back(i);
  }
  for (FieldSeam& seam : seams) {
    FieldGroup& group = groups[group_of[seam.sides[0].patch]];
    for (FieldSeam::Side& side : seam.sides) side.patch = place[side.patch];
    group.seams.push_back(seam);
  }
  return groups;
}

/// Edges of the background mesh over delta': no shorter. Half of that gives the same meshes (d4 by 0.2) in
/// eight times the time.
constexpr double kShortestEdge = 2;
/// Edges of the background mesh over the length on which delta' varies by a factor of e: no longer.
constexpr double kLongestEdge = 0.5;
/// Edges of the background mesh over the square root of the patch's area: no longer.
constexpr double kLargestPart = 1.0 / 70;

double area(const PatchBoundary& boundary) {
  double sum = 0;
  for (const auto& [i, j] : boundary.edges)
    sum += cross(boundary.points[i] - boundary.points[0], boundary.points[j] - boundary.points[0]) / 2;
  return sum;
}

/// Size of a background mesh that resolves how delta' varies, and is not finer than that. Its number of
/// elements stays bounded when delta' is scaled down. This does not hold next to the boundary, whose edges
/// are given.
class ResolvingSize final : public ParametricSize {
 public:
  /// `domain`: any triangulation of the patch.
  ResolvingSize(const ParametricSize& size, double largest, const BackgroundMesh& domain)
      : size_(size), largest_(largest), domain_(domain) {}

  double at(Vec2 u, int& hint) const override {
    const double delta = size_.at(u, hint), shortest = kShortestEdge * delta;
    if (shortest >= largest_) return shortest;
    double steepest = 0;
    int where = -1, near = hint;
    for (const Vec2 d : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}}) {
      const Vec2 x = inside(u + largest_ / 2 * d, where);
      const double distance = norm(x - u);
      if (distance > 0)
        steepest = std::max(steepest, std::abs(std::log(size_.at(x, near) / delta)) / distance);
    }
    return std::max(shortest, std::min(largest_, kLongestEdge / steepest));
  }

 private:
  /// The point of the patch nearest to u.
  Vec2 inside(Vec2 u, int& hint) const {
    const auto [t, b] = domain_.locate(u, hint);
    const TriPatch& tri = domain_.triangles();
    Vec2 x{0, 0};
    for (int k = 0; k < 3; ++k) x += b[k] * tri.points[tri.triangles[t][k]];
    return x;
  }

  const ParametricSize& size_;
  double largest_;
  const BackgroundMesh& domain_;
};

/// `domain`: the triangles between the nodes of the patch's boundary.
std::shared_ptr<const BackgroundMesh> resolve_size(const PatchSetup& patch, const BackgroundMesh& domain) {
  const ResolvingSize size(*patch.size, kLargestPart * std::sqrt(area(patch.boundary)), domain);
  return std::make_shared<BackgroundMesh>(
      mesh_frontal(patch.boundary, *make_l2_frontal(), *patch.cross, size));
}

}  // namespace

void make_crosses_size_aware(MeshingSetup& prepared, const PatchPullAt& pull) {
  std::vector<PatchSetup>& patches = prepared.patches;
  const auto n_points = [&](std::size_t i) { return static_cast<double>(patches[i].boundary.points.size()); };
  std::vector<std::shared_ptr<const BackgroundMesh>> backgrounds(patches.size());
  const auto resolve = [&](std::size_t i) {
    const FaceScope face = patch_scope(prepared, i);
    const auto domain = std::make_shared<BackgroundMesh>(constrained_delaunay(patches[i].boundary));
    if (!patches[i].cross) patches[i].cross = std::make_shared<HarmonicCrossField>(domain);
    backgrounds[i] = resolve_size(patches[i], *domain);
  };
  parallel_for(patches.size(), resolve, n_points);

  const std::vector<FieldGroup> groups = field_groups(prepared, backgrounds);
  std::vector<std::shared_ptr<const SizeAwareCrossField>> made(patches.size());
  parallel_for(
      groups.size(),
      [&](std::size_t g) {
        const FaceScope face = patch_scope(prepared, groups[g].patches.front());
        std::vector<FieldPatch> of_group;
        for (const int i : groups[g].patches) {
          of_group.push_back({backgrounds[i], patches[i].size.get(), patches[i].cross});
          if (pull) of_group.back().pull = [&pull, i](Vec2 u, int& hint) { return pull(i, u, hint); };
        }
        const auto fields = make_size_aware_fields(of_group, groups[g].seams);
        for (std::size_t k = 0; k < fields.size(); ++k) made[groups[g].patches[k]] = fields[k];
      },
      [&](std::size_t g) {
        double sum = 0;
        for (const int i : groups[g].patches) sum += n_points(i);
        return sum;
      });

  std::vector<std::array<double, 2>> dislocations(patches.size());  // before and now
  parallel_for(
      patches.size(),
      [&](std::size_t i) {
        const PatchSetup& patch = patches[i];
        const FaceScope face = patch_scope(prepared, i);
        dislocations[i] = {expected_dislocations(*backgrounds[i], *patch.cross, *patch.size),
                           expected_dislocations(*backgrounds[i], *made[i], *patch.size)};
      },
      n_points);

  prepared.crosses.singularities.clear();
  prepared.crosses.index_sum_and_expected = {0, 0};
  prepared.crosses.dislocations = {0, 0};
  for (const FieldGroup& group : groups) {
    const SizeAwareCrossField& field = *made[group.patches.front()];
    prepared.crosses.index_sum_and_expected->first += field.index_sum();
    prepared.crosses.index_sum_and_expected->second += 4 * field.euler_characteristic();
  }
  for (std::size_t i = 0; i < made.size(); ++i) {
    patches[i].cross = made[i];
    prepared.crosses.dislocations->first += dislocations[i][0];
    prepared.crosses.dislocations->second += dislocations[i][1];
    int hint = -1;
    for (const Singularity& s : made[i]->singularities())
      prepared.crosses.singularities.push_back({patches[i].lift(s.at, hint), s.index});
  }
}

double expected_row_ends(const MeshingSetup& prepared) {
  if (prepared.crosses.dislocations) return prepared.crosses.dislocations->second;
  std::vector<double> ends(prepared.patches.size());
  parallel_for(
      ends.size(),
      [&](std::size_t i) {
        const PatchSetup& patch = prepared.patches[i];
        const FaceScope face = patch_scope(prepared, i);
        const BackgroundMesh domain(constrained_delaunay(patch.boundary));
        ends[i] = expected_dislocations(*resolve_size(patch, domain), *patch.cross, *patch.size);
      },
      [&](std::size_t i) { return static_cast<double>(prepared.patches[i].boundary.points.size()); });
  return std::reduce(ends.begin(), ends.end());
}

}  // namespace delquad
