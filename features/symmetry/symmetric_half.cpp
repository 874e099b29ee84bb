// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sort_unique.h"
#include "features/symmetry/mirrored_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/cancel.h"
#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {
namespace {

/// Points so near to a plane, in parts of the diagonal and of the shortest edge at them, are moved onto it.
constexpr double kSnap = 0.5 * kSymmetric, kSnapOfEdge = 0.1;

/// Curves and sections of the half.
class HalfProjector final : public SurfaceProjector {
 public:
  HalfProjector(std::shared_ptr<const SurfaceProjector> base, SymmetryPlanes planes,
                const SymmetricHalf& half, std::vector<int> section_face)
      : base_(std::move(base)),
        planes_(std::move(planes)),
        whole_curve_(half.whole_curve),
        curve_planes_(half.curve_planes),
        section_face_(std::move(section_face)) {}
  Vec3 to_face(int face, const Vec3& x) const override { return base_->to_face(face, x); }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    constexpr int kSteps = 3;
    Vec3 y = x;
    if (whole_curve_[curve] >= 0) {
      y = base_->to_curve(whole_curve_[curve], y);
    } else {
      for (int step = 0; step < kSteps; ++step)
        y = base_->to_face(section_face_[curve], planes_.put_on_all(curve_planes_[curve], y));
    }
    return planes_.put_on_all(curve_planes_[curve], y);
  }
  PrincipalCurvatures curvatures(int face, const Vec3& x) const override {
    return base_->curvatures(face, x);
  }

 private:
  std::shared_ptr<const SurfaceProjector> base_;
  SymmetryPlanes planes_;
  std::vector<int> whole_curve_, curve_planes_, section_face_;
};

class SymmetricCutter {
 public:
  SymmetricCutter(const SurfaceModel& whole, const SymmetryPlanes& planes,
                  const std::vector<MirrorMatch>& matches, const SizeField& size, const std::string& where)
      : whole_(whole),
        planes_(planes),
        matches_(matches),
        size_(size),
        where_(where),
        diagonal_(delquad::diagonal(whole.fine)),
        n_curves_(static_cast<int>(whole.fine.curves.size())),
        n_faces_(static_cast<int>(whole.fine.regions.size())) {
    half_.model = whole;
    half_.face_planes.assign(n_faces_, 0);
  }

  SymmetricHalf run() {
    const std::size_t n_points = mesh().points.size();
    on_.assign(n_points, 0);
    shared_.assign(n_points, 0);
    for (int k = 0; k < planes_.count(); ++k) {
      check_cancelled();
      snap(k);
      split(k);
      keep_positive_side(k);
    }
    corner_.assign(mesh().points.size(), 0);
    for (const int p : half_.model.corners) corner_[p] = 1;
    add_images_of_corners();
    drop_unused();
    make_curves();
    finish_projector();
    return std::move(half_);
  }

 private:
  Mesh& mesh() { return half_.model.fine; }
  bool is_on(int plane, int p) const { return on_[p] >> plane & 1; }

  void snap(int plane) {
    std::vector<double> shortest(mesh().points.size(), diagonal_);
    for (const auto& v : mesh().triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = v[k], b = v[(k + 1) % 3];
        const double length = norm(mesh().points[b] - mesh().points[a]);
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    constexpr double kRounding = 1e-12;
    for (std::size_t p = 0; p < shortest.size(); ++p) {
      const double tolerance =
          std::max(kRounding * diagonal_, std::min(kSnap * diagonal_, kSnapOfEdge * shortest[p]));
      if (std::abs(planes_.height(plane, mesh().points[p])) > tolerance) continue;
      on_[p] |= 1 << plane;
      mesh().points[p] = planes_.put_on_all(on_[p], mesh().points[p]);
    }
  }

  double height(int plane, int p) const {
    return is_on(plane, p) ? 0 : planes_.height(plane, half_.model.fine.points[p]);
  }

  /// Puts a point on each edge that crosses the plane.
  void split(int plane) {
    SurfaceEditor editor(half_.model);
    std::vector<std::array<int, 2>> edges;
    for_each_edge(sorted_half_edges(mesh()), [&](std::span<const HalfEdge> edge) {
      if (height(plane, edge[0].lo) * height(plane, edge[0].hi) < 0)
        edges.push_back({edge[0].lo, edge[0].hi});
    });
    for (const auto& [a, b] : edges) {
      const double ha = height(plane, a), t = ha / (ha - height(plane, b));
      const int line = editor.line_on(a, b);
      const int region = mesh().triangle_region[editor.triangles_on(a, b).front()];
      // A place between two on another plane is on that one, too, where the edge runs along it.
      const int along = line >= 0 ? shared_[a] & shared_[b] : half_.face_planes[region];
      const Vec3 chord = (1 - t) * mesh().points[a] + t * mesh().points[b];
      const int curve = line < 0 ? -1 : mesh().line_curve[line];
      const int mask = 1 << plane | along;
      editor.split_edge(a, b,
                        on_surface(chord, curve, region, mask, norm(mesh().points[b] - mesh().points[a])));
      on_.push_back(mask);
      shared_.push_back(along);
    }
    editor.finish();
  }

  /// On the planes, and on the true surface where that is near.
  Vec3 on_surface(const Vec3& x, int curve, int face, int mask, double edge) const {
    constexpr double kMaxMove = 0.1;
    constexpr int kSteps = 3;
    const Vec3 flat = planes_.put_on_all(mask, x);
    if (!whole_.projector) return flat;
    Vec3 y = flat;
    for (int step = 0; step < kSteps; ++step) {
      y = curve >= 0 && curve < n_curves_ ? whole_.projector->to_curve(curve, y)
                                          : whole_.projector->to_face(face, y);
      y = planes_.put_on_all(mask, y);
    }
    return norm(y - flat) <= kMaxMove * edge ? y : flat;
  }

  enum class Side : char { kKept, kDropped, kInPlane };

  Side side_of(int plane, const std::array<int, 3>& v) const {
    for (const int p : v)
      if (!is_on(plane, p))
        return planes_.height(plane, half_.model.fine.points[p]) > 0 ? Side::kKept : Side::kDropped;
    const auto& x = half_.model.fine.points;
    const Vec3 d[3] = {x[v[1]] - x[v[0]], x[v[2]] - x[v[1]], x[v[0]] - x[v[2]]};
    const double longest = std::max({norm(d[0]), norm(d[1]), norm(d[2])});
    constexpr double kSliver = 1e-6;  // no area, and so in no plane
    return norm(cross(d[0], d[1])) > kSliver * longest * longest ? Side::kInPlane : Side::kKept;
  }

  void keep_positive_side(int plane) {
    std::vector<Side> side;
    for (const auto& v : mesh().triangles) side.push_back(side_of(plane, v));
    settle_faces_in_plane(plane, side);
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh());
    mark_shared(plane, side);
    add_sections(plane, side, sides);
    keep_triangles(mesh(), [&](std::size_t t) { return side[t] != Side::kDropped; });
    drop_stray_lines(mesh(), sorted_half_edges(mesh()));
  }

  /// A face in the plane is its own image, or the image of another one there; one of both is kept.
  void settle_faces_in_plane(int plane, std::vector<Side>& side) {
    std::vector<char> lies_in(n_faces_, 0), lies_off(n_faces_, 0);
    for (std::size_t t = 0; t < side.size(); ++t)
      (side[t] == Side::kInPlane ? lies_in : lies_off)[mesh().triangle_region[t]] = 1;
    std::vector<int> neighbours(n_faces_, 0);  // on the positive side less those on the negative one
    std::vector<int> weight(mesh().points.size(), 0);
    for (std::size_t t = 0; t < side.size(); ++t)
      for (const int v : mesh().triangles[t])
        if (side[t] != Side::kInPlane) weight[v] += side[t] == Side::kKept ? 1 : -1;
    for (std::size_t t = 0; t < side.size(); ++t)
      if (side[t] == Side::kInPlane)
        for (const int v : mesh().triangles[t])
          neighbours[mesh().triangle_region[t]] += (weight[v] > 0) - (weight[v] < 0);
    for (int f = 0; f < n_faces_; ++f) {
      if (!lies_in[f]) continue;
      if (lies_off[f])
        throw InputError(
            fmt::format("{}: a part of face {} lies in the plane of symmetry, but not all of it: expected a "
                        "face of its own",
                        where_, mesh().regions[f].tag));
      const int image = matches_[plane].face[f];
      if (image == f) {
        half_.face_planes[f] |= 1 << plane;
        continue;
      }
      const bool goes = neighbours[f] != neighbours[image] ? neighbours[f] < neighbours[image] : image < f;
      for (std::size_t t = 0; t < side.size(); ++t)
        if (mesh().triangle_region[t] == f) side[t] = goes ? Side::kDropped : Side::kKept;
    }
  }

  /// Points on the plane that triangles on both sides have, or those in it.
  void mark_shared(int plane, const std::vector<Side>& side) {
    std::vector<char> before(mesh().points.size(), 0), behind(mesh().points.size(), 0);
    for (std::size_t t = 0; t < side.size(); ++t)
      for (const int v : mesh().triangles[t]) {
        if (side[t] != Side::kDropped) before[v] = 1;
        if (side[t] != Side::kKept) behind[v] = 1;
      }
    for (std::size_t p = 0; p < before.size(); ++p)
      if (is_on(plane, static_cast<int>(p)) && before[p] && behind[p]) shared_[p] |= 1 << plane;
  }

  /// Where a face goes on behind the plane, a line.
  void add_sections(int plane, const std::vector<Side>& side, const std::vector<HalfEdge>& sides) {
    std::set<std::pair<int, int>> has_line;
    for (const auto& [a, b] : mesh().lines) has_line.insert(std::minmax(a, b));
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      const int a = edge[0].lo, b = edge[0].hi;
      if (!is_on(plane, a) || !is_on(plane, b) || has_line.contains({a, b})) return;
      int kept = -1;
      bool dropped = false;
      for (const HalfEdge& half : edge) {
        if (side[half.element] == Side::kDropped)
          dropped = true;
        else
          kept = half.element;
      }
      if (!dropped || kept < 0) return;
      mesh().lines.push_back({a, b});
      mesh().line_curve.push_back(n_curves_ + plane * n_faces_ + mesh().triangle_region[kept]);
    });
  }

  /// Corners behind planes have their images in the half.
  void add_images_of_corners() {
    const Mesh& fine = whole_.fine;
    std::vector<int> wanted = whole_.corners;
    std::set<int> named;
    for (const NamedPoint& n : fine.named_points) named.insert(n.point);
    std::vector<char> of_dangling_only(fine.points.size(), 0), of_others(fine.points.size(), 0);
    std::vector<char> is_dangling(n_curves_, 0);
    for (const EmbeddedCurve& e : whole_.embedded) is_dangling[e.curve] = e.is_dangling;
    for (std::size_t l = 0; l < fine.lines.size(); ++l)
      for (const int v : fine.lines[l])
        (is_dangling[fine.line_curve[l]] ? of_dangling_only : of_others)[v] = 1;
    std::vector<int> lines_at(fine.points.size(), 0);
    for (const auto& line : fine.lines)
      for (const int v : line) ++lines_at[v];
    const std::vector<char> is_start = smooth_starts();
    SurfaceEditor editor(half_.model);
    for (const int p : wanted) {
      const int folds = planes_.folds_of(fine.points[p], kSnap * diagonal_);
      if (folds == 0) continue;
      if (is_start[p] && !named.contains(p)) continue;
      // The far end of a dangling curve may be anywhere.
      if (!of_others[p] && lines_at[p] < 2 && !named.contains(p)) continue;
      if (put_corner(editor, planes_.reflect_all(folds, fine.points[p]))) continue;
      const bool is_point = named.contains(p);
      if (!is_point && !of_others[p]) continue;
      throw InputError(
          fmt::format("{}: the model is not symmetric: {} at {} has no mirror image at {} [not-symmetric]",
                      where_, is_point ? "the point '" + name_of(p) + "'" : "the corner",
                      show_point(fine.points[p]), show_point(planes_.reflect_all(folds, fine.points[p]))));
    }
    editor.finish();
  }

  /// Returns for each point of the whole whether only a closed curve begins there, which might do so
  /// anywhere.
  std::vector<char> smooth_starts() const {
    constexpr double kSmooth = 30 * std::numbers::pi / 180;
    const Mesh& fine = whole_.fine;
    std::vector<std::vector<int>> next(fine.points.size());
    std::vector<int> curve(fine.points.size(), -1);
    std::vector<char> is_start(fine.points.size(), 1);
    for (std::size_t l = 0; l < fine.lines.size(); ++l)
      for (const int k : {0, 1}) {
        const int v = fine.lines[l][k];
        if (!next[v].empty() && curve[v] != fine.line_curve[l]) is_start[v] = 0;
        next[v].push_back(fine.lines[l][1 - k]);
        curve[v] = fine.line_curve[l];
      }
    for (std::size_t v = 0; v < is_start.size(); ++v)
      is_start[v] = is_start[v] && next[v].size() == 2 &&
                    turn_angle(fine.points[next[v][0]], fine.points[v], fine.points[next[v][1]]) < kSmooth;
    return is_start;
  }

  std::string name_of(int p) const {
    for (const NamedPoint& n : whole_.fine.named_points)
      if (n.point == p && !n.entity.names.empty()) return n.entity.names[0];
    return {};
  }

  /// Whether there is a corner at x, or a curve on which there is one now.
  bool put_corner(SurfaceEditor& editor, const Vec3& x) {
    const double tolerance = kSymmetric * diagonal_;
    for (std::size_t p = 0; p < corner_.size(); ++p)
      if (corner_[p] && editor.is_on_line(static_cast<int>(p)) && norm(mesh().points[p] - x) <= tolerance)
        return true;
    double best = tolerance;
    std::array<int, 2> line{-1, -1};
    double along = 0;
    for (std::size_t l = 0; l < mesh().lines.size(); ++l) {
      if (mesh().line_curve[l] >= n_curves_) continue;
      const Vec3 a = mesh().points[mesh().lines[l][0]], d = mesh().points[mesh().lines[l][1]] - a;
      const double t = nearest_part(x, a, mesh().points[mesh().lines[l][1]]);
      // A chord may be as far off as it sags.
      double distance = norm(a + t * d - x);
      if (distance > best + norm(d)) continue;
      distance -= sag(mesh().line_curve[l], a + t * d);
      if (distance > best) continue;
      best = distance;
      line = mesh().lines[l];
      along = t;
    }
    if (line[0] < 0) return false;
    constexpr double kEnd = 1e-3;
    if (along < kEnd || along > 1 - kEnd) {
      corner_[along < kEnd ? line[0] : line[1]] = 1;
      return true;
    }
    const auto [a, b] = line;
    const int mask = shared_[a] & shared_[b];
    const int curve = mesh().line_curve[editor.line_on(a, b)];
    const Vec3 chord = (1 - along) * mesh().points[a] + along * mesh().points[b];
    const int p = editor.split_edge(
        a, b, on_surface(chord, curve, -1, mask, norm(mesh().points[b] - mesh().points[a])));
    on_.push_back(mask);
    shared_.push_back(mask);
    corner_.push_back(0);
    corner_[p] = 1;
    return true;
  }

  double sag(int curve, const Vec3& x) const {
    return whole_.projector ? norm(whole_.projector->to_curve(curve, x) - x) : 0;
  }

  /// Takes out points that no triangle has.
  void drop_unused() {
    std::vector<char> used(mesh().points.size(), 0);
    for (const auto& v : mesh().triangles)
      for (const int p : v) used[p] = 1;
    std::size_t kept = 0;
    for (std::size_t p = 0; p < used.size(); ++p) {
      if (!used[p]) continue;
      on_[kept] = on_[p];
      shared_[kept] = shared_[p];
      corner_[kept++] = corner_[p];
    }
    for (auto* some : {&on_, &shared_}) some->resize(kept);
    corner_.resize(kept);
    drop_unused_points(mesh());
  }

  int planes_of_line(const std::array<int, 2>& line) const { return shared_[line[0]] & shared_[line[1]]; }

  /// Lines become curves anew, each a piece of a curve of the whole or a section.
  void make_curves() {
    std::vector<char> on_line(mesh().points.size(), 0);
    std::vector<int> planes_at(mesh().points.size(), -1);
    std::set<std::array<int, 2>> forward;
    for (const auto& line : mesh().lines) {
      forward.insert(line);
      for (const int v : line) {
        if (on_line[v] && planes_at[v] != planes_of_line(line)) corner_[v] = 1;
        on_line[v] = 1;
        planes_at[v] = planes_of_line(line);
      }
    }
    for (std::size_t p = 0; p < corner_.size(); ++p) corner_[p] = corner_[p] && on_line[p];
    const std::vector<int> kind = mesh().line_curve;
    std::vector<int> given;
    std::size_t line = 0;
    for (const auto& chain : chain_lines(half_.model, kind, corner_)) {
      const int of = kind[chain[0]];
      given.push_back(of < n_curves_ ? of : -1);
      section_face_.push_back(of < n_curves_ ? -1 : (of - n_curves_) % n_faces_);
      int mask = -1;
      const std::size_t end = line + chain.size();
      for (std::size_t l = line; l < end; ++l) mask &= planes_of_line(mesh().lines[l]);
      half_.curve_planes.push_back(mask);
      // As the whole runs.
      if (!forward.contains(mesh().lines[line])) {
        std::reverse(mesh().lines.begin() + static_cast<std::ptrdiff_t>(line),
                     mesh().lines.begin() + static_cast<std::ptrdiff_t>(end));
        for (std::size_t l = line; l < end; ++l) std::swap(mesh().lines[l][0], mesh().lines[l][1]);
      }
      line = end;
    }
    mesh().curves = entities_of_pieces(whole_.fine.curves, given);
    half_.whole_curve = std::move(given);
    split_short_curves();
    find_embedded();
    find_touching();
  }

  bool is_crack(int curve) const {
    const int whole = half_.whole_curve[curve];
    return std::ranges::any_of(whole_.embedded, [&](const EmbeddedCurve& e) {
      return e.is_crack && whole >= 0 && e.curve == whole;
    });
  }

  /// Curves from plane to plane, and cracks on planes, that a mesh might have as one edge.
  void split_short_curves() {
    constexpr double kSizes = 3;
    std::vector<int>& corners = half_.model.corners;
    for (std::size_t begin = 0, end; begin < mesh().lines.size(); begin = end) {
      const int curve = mesh().line_curve[begin];
      double length = 0;
      for (end = begin; end < mesh().lines.size() && mesh().line_curve[end] == curve; ++end)
        length += length_of(end);
      const int first = mesh().lines[begin][0], last = mesh().lines[end - 1][1];
      const int both = shared_[first] & shared_[last] & ~(is_crack(curve) ? 0 : half_.curve_planes[curve]);
      if (both == 0 || length > kSizes * size_.at(mesh().points[first], hint_)) continue;
      double along = 0;
      std::size_t middle = begin;
      while (along < length / 2) along += length_of(middle++);
      const int p = middle < end ? mesh().lines[middle][0] : mesh().lines[begin][1];
      if (p != first && p != last) corners.push_back(p);
    }
    sort_unique(corners);
  }
  double length_of(std::size_t line) {
    return norm(mesh().points[mesh().lines[line][1]] - mesh().points[mesh().lines[line][0]]);
  }

  void find_embedded() {
    std::multimap<int, EmbeddedCurve> of;
    for (const EmbeddedCurve& e : whole_.embedded) of.emplace(e.curve, e);
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh());
    half_.model.embedded.clear();
    int before = -1;
    for (std::size_t l = 0; l < mesh().lines.size(); ++l) {
      const int curve = mesh().line_curve[l];
      if (std::exchange(before, curve) == curve) continue;
      const auto [first, last] = of.equal_range(half_.whole_curve[curve]);
      for (const auto& [whole, e] : std::ranges::subrange(first, last)) {
        const auto on_both_sides = std::ranges::count_if(
            sides_of_edge(sides, mesh().lines[l][0], mesh().lines[l][1]),
            [&](const HalfEdge& s) { return mesh().triangle_region[s.element] == e.face; });
        if (on_both_sides == 2) half_.model.embedded.push_back({curve, e.face, e.is_dangling, e.is_crack});
      }
    }
  }

  void find_touching() {
    std::vector<int> known(mesh().points.size(), 0), here(mesh().points.size(), 0);
    for (std::size_t l = 0; l < mesh().lines.size(); ++l)
      for (const int v : mesh().lines[l]) {
        here[v] = 1;
        known[v] |= half_.curve_planes[mesh().line_curve[l]];
      }
    for (std::size_t p = 0; p < known.size(); ++p)
      if (here[p] != 0 && (shared_[p] & ~known[p]) != 0)
        half_.touching.push_back({mesh().points[p], shared_[p]});
  }

  void finish_projector() {
    if (whole_.projector)
      half_.model.projector =
          std::make_shared<HalfProjector>(whole_.projector, planes_, half_, std::move(section_face_));
  }

  const SurfaceModel& whole_;
  const SymmetryPlanes& planes_;
  const std::vector<MirrorMatch>& matches_;
  const SizeField& size_;
  int hint_ = -1;
  const std::string& where_;
  double diagonal_;
  int n_curves_, n_faces_;
  SymmetricHalf half_;
  std::vector<int> on_, shared_;  // of each point, the bits of planes
  std::vector<char> corner_;
  std::vector<int> section_face_;
};

}  // namespace

SymmetricHalf cut_symmetric(const SurfaceModel& whole, const SymmetryPlanes& planes,
                            const std::vector<MirrorMatch>& matches, const SizeField& size,
                            const std::string& where) {
  return SymmetricCutter(whole, planes, matches, size, where).run();
}

}  // namespace delquad
