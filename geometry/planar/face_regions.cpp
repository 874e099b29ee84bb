// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/face_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "base/text.h"
#include "delquad/error.h"

namespace delquad {

namespace {

void name_the_unnamed(std::vector<Entity>& regions) {
  const auto n_unnamed = std::ranges::count_if(regions, [](const Entity& r) { return r.names.empty(); });
  int number = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    regions[r].tag = static_cast<int>(r) + 1;
    if (regions[r].names.empty())
      regions[r].names.push_back(n_unnamed == 1 ? "domain" : fmt::format("domain_{}", ++number));
  }
}

double signed_area(const Mesh& lines, const Arrangement::Cycle& cycle) {
  double area = 0;
  for (const int side : cycle) {
    const Vec3 &a = lines.points[start_of(lines.lines, side)],
               &b = lines.points[start_of(lines.lines, side ^ 1)];
    area += (a.x * b.y - a.y * b.x) / 2;
  }
  return area;
}

/// Finds the loops around each face, and their nesting.
class LoopsAround {
 public:
  LoopsAround(const Mesh& lines, const Arrangement& arrangement, const std::vector<ModelLoop>& loops,
              const std::vector<std::vector<int>>& loops_of_curve, const BoundaryNames& names)
      : lines_(lines),
        arrangement_(arrangement),
        loops_(loops),
        names_(names),
        of_curve_(loops_of_curve),
        around_(arrangement.faces.size()),
        area_(loops.size(), 0),
        parent_(loops.size(), kUnknown) {
    spread();
    sort_by_area();
    for (const std::vector<int>& around : around_) nest(around);
    check_duplicates();
  }

  /// Returns the innermost loop around a face; -1: none.
  int innermost(std::size_t face) const { return around_[face].empty() ? -1 : around_[face].back(); }

  /// Returns for each loop whether there is a region just inside.
  std::vector<char> filled() const {
    std::vector<int> order(loops_.size());
    for (std::size_t l = 0; l < order.size(); ++l) order[l] = static_cast<int>(l);
    std::ranges::stable_sort(order, [&](int a, int b) { return area_[a] > area_[b]; });
    std::vector<char> filled(loops_.size(), 0);
    for (const int l : order) filled[l] = !loops_[l].region.empty() || parent_[l] < 0 || !filled[parent_[l]];
    return filled;
  }

 private:
  static constexpr int kNone = -1, kUnknown = -2;

  std::string label(int loop) const {
    const ModelLoop& l = loops_[loop];
    if (!l.where.empty()) return "the loop of " + l.where;
    return "the loop of " + names_.curve(l.curves.front());
  }

  /// Walks from the unbounded face over all lines; to cross a line is to enter or leave its loops.
  void spread() {
    const std::size_t n_lines = lines_.lines.size();
    std::vector<std::vector<int>> sides_of(arrangement_.faces.size());
    std::vector<int> open;  // sides of faces to visit
    for (std::size_t s = 0; s < 2 * n_lines; ++s) {
      const int face = arrangement_.face_of[s];
      if (face < 0)
        open.push_back(static_cast<int>(s));
      else
        sides_of[face].push_back(static_cast<int>(s));
    }
    std::vector<char> met(arrangement_.faces.size(), 0);
    while (!open.empty()) {
      const int side = open.back();
      open.pop_back();
      const int from = arrangement_.face_of[side], to = arrangement_.face_of[side ^ 1];
      if (to < 0 || met[to]) continue;
      met[to] = 1;
      if (from >= 0) around_[to] = around_[from];
      for (const int loop : of_curve_[lines_.line_curve[side / 2]]) {
        const auto at = std::ranges::find(around_[to], loop);
        if (at == around_[to].end())
          around_[to].push_back(loop);
        else
          around_[to].erase(at);
      }
      open.insert(open.end(), sides_of[to].begin(), sides_of[to].end());
    }
  }

  void sort_by_area() {
    for (std::size_t f = 0; f < around_.size(); ++f) {
      double area = 0;
      for (const auto& cycle : arrangement_.faces[f].cycles) area += signed_area(lines_, cycle);
      for (const int loop : around_[f]) area_[loop] += area;
    }
    // If two loops are equal, the one with a name fills the other.
    for (std::vector<int>& around : around_)
      std::ranges::sort(around, {},
                        [&](int l) { return std::tuple(-area_[l], !loops_[l].region.empty(), l); });
  }

  /// Nests the loops `around` a face, the largest first.
  void nest(const std::vector<int>& around) {
    int outer = kNone;
    for (const int loop : around) {
      if (parent_[loop] == kUnknown) parent_[loop] = outer;
      if (parent_[loop] != outer) {
        const int other = std::max(parent_[loop], outer);
        throw InputError(
            fmt::format("{}{} and {} overlap: one of two loops may lie inside the other, or they "
                        "lie side by side [overlapping-regions]",
                        names_.prefix(), label(other), label(loop)));
      }
      outer = loop;
    }
  }

  /// Throws InputError for two equal loops, unless exactly one of them names a region.
  void check_duplicates() const {
    for (std::size_t l = 0; l < loops_.size(); ++l) {
      const int parent = parent_[l];
      if (parent < 0 || area_[parent] != area_[l] ||
          loops_[parent].region.empty() != loops_[l].region.empty())
        continue;
      throw InputError(
          fmt::format("{}{} and {} consist of the same curves: one of them is too many [overlapping-regions]",
                      names_.prefix(), label(parent), label(static_cast<int>(l))));
    }
  }

  const Mesh& lines_;
  const Arrangement& arrangement_;
  const std::vector<ModelLoop>& loops_;
  const BoundaryNames& names_;
  const std::vector<std::vector<int>>& of_curve_;
  std::vector<std::vector<int>> around_;  ///< loops around each face, the largest first
  std::vector<double> area_;
  std::vector<int> parent_;
};

}  // namespace

FaceRegions regions_by_nesting(const Arrangement& arrangement, const FaceNames& names) {
  FaceRegions result;
  std::set<int> known;  // components
  for (std::size_t f = 0; f < names.size(); ++f)
    if (names[f]) known.insert(arrangement.faces[f].component);
  // The face around a face comes before it.
  for (std::size_t f = 0; f < arrangement.faces.size(); ++f) {
    const auto& face = arrangement.faces[f];
    const bool may_be = face.around < 0 || result.region[face.around] < 0;
    const bool filled = names[f] || (may_be && !known.contains(face.component));
    result.region.push_back(filled ? static_cast<int>(result.regions.size()) : -1);
    if (filled) result.regions.push_back({0, names[f].value_or(std::vector<std::string>{})});
  }
  name_the_unnamed(result.regions);
  return result;
}

FaceRegions regions_of_loops(const Mesh& lines, const Arrangement& arrangement,
                             const std::vector<ModelLoop>& loops,
                             const std::vector<std::vector<int>>& loops_of_curve,
                             const BoundaryNames& names) {
  const LoopsAround around(lines, arrangement, loops, loops_of_curve, names);
  const std::vector<char> filled = around.filled();
  FaceRegions result;
  std::vector<int> region_of(loops.size(), -1);
  for (std::size_t f = 0; f < arrangement.faces.size(); ++f) {
    const int loop = around.innermost(f);
    if (loop < 0 || !filled[loop]) {
      result.region.push_back(-1);
      continue;
    }
    if (region_of[loop] < 0) {
      region_of[loop] = static_cast<int>(result.regions.size());
      Entity& region = result.regions.emplace_back();
      if (!loops[loop].region.empty()) region.names.push_back(loops[loop].region);
    }
    result.region.push_back(region_of[loop]);
  }
  if (result.regions.empty()) throw InputError(names.prefix() + "the loops enclose nothing [empty-domain]");
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (loops[l].is_hole && filled[l]) {
      const Vec3& at = lines.points[lines.lines[std::ranges::find(lines.line_curve, loops[l].curves.front()) -
                                                lines.line_curve.begin()][0]];
      throw InputError(fmt::format("{}: the hole through {} lies outside of every region [embedded-outside]",
                                   loops[l].where, show_point(Vec2{at.x, at.y})));
    }
    if (!loops[l].region.empty() && region_of[l] < 0)
      throw InputError(fmt::format("{}: region '{}' is empty: other loops fill its loop", loops[l].where,
                                   loops[l].region));
  }
  name_the_unnamed(result.regions);
  return result;
}

}  // namespace delquad
