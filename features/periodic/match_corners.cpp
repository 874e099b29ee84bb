// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sort_unique.h"
#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "base/cancel.h"
#include "base/segment.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {
namespace {

/// Corners are images of images: of three pairs of faces a corner has seven.
constexpr int kImageRounds = 16;

std::vector<int> lines_at_face(const Mesh& fine, int face, std::size_t n_curves) {
  std::vector<std::array<int, 2>> sides;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    if (fine.triangle_region[t] == face)
      for (int k = 0; k < 3; ++k)
        sides.push_back(side_of(fine.triangles[t][k], fine.triangles[t][(k + 1) % 3]));
  std::ranges::sort(sides);
  std::vector<int> lines;
  for (std::size_t l = 0; l < fine.lines.size(); ++l)
    if (fine.line_curve[l] < static_cast<int>(n_curves) &&
        std::ranges::binary_search(sides, side_of(fine.lines[l][0], fine.lines[l][1])))
      lines.push_back(static_cast<int>(l));
  return lines;
}

std::vector<int> lines_of_curves(const Mesh& fine, const std::string& name) {
  const std::vector<int> curves = entities_named(fine.curves, "curve", name);
  std::vector<int> lines;
  for (std::size_t l = 0; l < fine.lines.size(); ++l)
    if (std::ranges::binary_search(curves, fine.line_curve[l])) lines.push_back(static_cast<int>(l));
  return lines;
}

/// Images of the corners on some lines become corners on others.
class CornerMatcher {
 public:
  explicit CornerMatcher(SurfaceModel& model)
      : model_(model), fine_(model.fine), tolerance_(kPeriodicTolerance * diagonal(model.fine)) {}

  void match(const PairedLines& pair, bool forward) {
    const auto& [a, b] = forward ? std::tie(pair.from, pair.to) : std::tie(pair.to, pair.from);
    const Motion motion = forward ? pair.of.motion : pair.of.motion.inverse();
    std::vector<std::array<int, 2>> parts;
    std::vector<int> curve;
    for (const int l : b) parts.push_back(fine_.lines[l]), curve.push_back(fine_.line_curve[l]);
    for (const int v : corners_on(a)) {
      check_cancelled();
      const Vec3 x = motion(fine_.points[v]);
      const Nearest found = nearest(parts, x);
      if (found.line < 0) refuse(pair, forward, v, x, found.distance);
      const auto [p, q] = parts[found.line];
      const int end = norm(fine_.points[p] - x) <= norm(fine_.points[q] - x) ? p : q;
      if (norm(fine_.points[end] - x) <= tolerance_) {
        make_corner(end);
        continue;
      }
      const double off =
          model_.projector ? norm(model_.projector->to_curve(curve[found.line], x) - x) : found.distance;
      if (off > tolerance_) refuse(pair, forward, v, x, off);
      if (!editor_) editor_.emplace(model_);
      const int node = editor_->split_edge(p, q, x);
      parts[found.line] = {p, node};
      parts.push_back({node, q});
      curve.push_back(curve[found.line]);
      make_corner(node);
    }
  }

  /// Before the model's lines are read again; returns the editor's splits.
  std::vector<std::pair<int, int>> finish() {
    if (!editor_) return {};
    editor_->finish();
    return editor_->splits();
  }
  bool has_changed() const { return has_changed_; }

 private:
  std::vector<int> corners_on(const std::vector<int>& lines) const {
    std::vector<int> corners;
    for (const int l : lines)
      for (const int v : fine_.lines[l])
        if (std::ranges::binary_search(model_.corners, v)) corners.push_back(v);
    sort_unique(corners);
    return corners;
  }

  void make_corner(int v) {
    const auto at = std::ranges::lower_bound(model_.corners, v);
    if (at != model_.corners.end() && *at == v) return;
    model_.corners.insert(at, v);
    has_changed_ = true;
  }

  struct Nearest {
    int line = -1;
    double t = 0, distance = std::numeric_limits<double>::infinity();
  };

  Nearest nearest(const std::vector<std::array<int, 2>>& parts, const Vec3& x) const {
    Nearest best;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Vec3 &a = fine_.points[parts[i][0]], &b = fine_.points[parts[i][1]];
      const double t = nearest_part(x, a, b), distance = norm(a + t * (b - a) - x);
      if (distance < best.distance) best = {static_cast<int>(i), t, distance};
    }
    return best;
  }

  [[noreturn]] void refuse(const PairedLines& pair, bool is_forward, int v, const Vec3& x, double off) const {
    const auto& [from, to] =
        is_forward ? std::pair(pair.of.from, pair.of.to) : std::pair(pair.of.to, pair.of.from);
    const Vec3& at = fine_.points[v];
    throw InputError(fmt::format(
        "{}: the sides do not match: the image of ({:.10g}, {:.10g}, {:.10g}) on a curve of '{}', "
        "({:.10g}, {:.10g}, {:.10g}), is {:.3g} away from the curves of '{}' [periodic-mismatch]",
        pair.of.where, at.x, at.y, at.z, from, x.x, x.y, x.z, off, to));
  }

  SurfaceModel& model_;
  Mesh& fine_;
  double tolerance_;
  std::optional<SurfaceEditor> editor_;
  bool has_changed_ = false;
};

/// Gives each closed curve on the lines that has no corner one.
void add_first_corners(SurfaceModel& model, const std::vector<int>& lines) {
  std::map<int, int> first;  // point of each curve; -1: it has a corner
  for (const int l : lines) {
    int& point = first.try_emplace(model.fine.line_curve[l], model.fine.lines[l][0]).first->second;
    for (const int v : model.fine.lines[l])
      if (std::ranges::binary_search(model.corners, v)) point = -1;
  }
  for (const auto& [curve, point] : first)
    if (point >= 0) model.corners.insert(std::ranges::upper_bound(model.corners, point), point);
}

}  // namespace

std::size_t n_pairs(const PeriodicSides& sides) { return sides.curves.size() + sides.faces.size(); }

PairedLines paired_lines(const Mesh& fine, const PeriodicSides& sides, std::size_t pair,
                         std::size_t n_curves) {
  if (pair < sides.curves.size()) {
    const PeriodicPair& of = sides.curves[pair];
    return {lines_of_curves(fine, of.from), lines_of_curves(fine, of.to), of};
  }
  const FacePair& of = sides.faces[pair - sides.curves.size()];
  return {lines_at_face(fine, of.master, n_curves), lines_at_face(fine, of.face, n_curves), of.of};
}

namespace {

std::vector<std::pair<int, int>> match_corners(SurfaceModel& model, const PeriodicSides& sides,
                                               std::size_t n_curves) {
  std::vector<std::pair<int, int>> splits;
  for (std::size_t i = 0; i < n_pairs(sides); ++i)
    add_first_corners(model, paired_lines(model.fine, sides, i, n_curves).from);
  for (int round = 0; round < kImageRounds; ++round) {
    bool has_changed = false;
    for (std::size_t i = 0; i < n_pairs(sides); ++i)
      for (const bool forward : {true, false}) {
        CornerMatcher matcher(model);
        matcher.match(paired_lines(model.fine, sides, i, n_curves), forward);
        const auto more = matcher.finish();
        splits.insert(splits.end(), more.begin(), more.end());
        has_changed = has_changed || matcher.has_changed();
      }
    if (!has_changed) return splits;
  }
  const PeriodicPair& first = sides.faces.empty() ? sides.curves[0] : sides.faces[0].of;
  throw InputError(first.where +
                   ": the motions of periodic sides do not fit together: images of corners have "
                   "images without end");
}

}  // namespace

Flattening flatten_periodic(SurfaceModel& model, const PeriodicSides& periodic) {
  if (periodic.empty()) return flatten(model);
  FlattenOptions options;
  options.left_out.assign(model.fine.regions.size(), 0);
  for (const FacePair& pair : periodic.faces) options.left_out[pair.face] = 1;
  const std::size_t n_curves = model.fine.curves.size();
  options.after_cuts = [&] { return match_corners(model, periodic, n_curves); };
  match_corners(model, periodic, n_curves);
  return flatten(model, options);
}

}  // namespace delquad
