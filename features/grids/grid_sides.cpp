// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/grids/grids.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/box.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

/// Limits of automatic grids. Angles of corners and of other nodes may differ so much from 90 and 180
/// degrees. Wanted numbers of edges of opposite sides have at most this ratio.
constexpr double kCornerSlack = 35, kStraightSlack = 30, kMostSideRatio = 2.05;
/// So near to a node a corner is told, in diagonals of the outline.
constexpr double kCornerReach = 1e-3;
/// Curves of what is found of itself get numbers of edges within this ratio of what they want, or one more or
/// less.
constexpr double kMostChange = 1.45;
/// Faces are narrow up to this width, in sizes, where they are longer: two rows of quads.
constexpr double kNarrow = 2.5;
/// As many curves are named where numbers of edges do not agree.
constexpr std::size_t kMostCurvesNamed = 4;

using Loop = std::vector<OutlinePart>;

double in_degrees(double angle) { return angle * 180 / std::numbers::pi; }

double turn_from(const OutlinePart& part, double angle) { return std::abs(in_degrees(part.angle) - angle); }

/// Places of the nodes that turn more as a rectangle's corners do come first.
std::vector<std::size_t> by_turn(const Loop& loop) {
  std::vector<std::size_t> order(loop.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  // The value is larger if the angle is nearer to a right one than to a straight one.
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t i) { return turn_from(loop[i], 180) - turn_from(loop[i], 90); });
  return order;
}

std::vector<std::size_t> corners_by_angle(const Loop& loop) {
  std::vector<std::size_t> turning;
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (in_degrees(loop[i].angle) < 180 - kStraightSlack) turning.push_back(i);
  if (turning.size() == 3) return turning;
  std::vector<std::size_t> corners = by_turn(loop);
  corners.resize(std::min<std::size_t>(corners.size(), 4));
  std::ranges::sort(corners);
  return corners;
}

MappedFace cut_at(int face, const Loop& loop, const std::vector<std::size_t>& corners) {
  MappedFace mapped{face, true, {}, corners};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    auto& side = mapped.sides.emplace_back();
    const std::size_t end = corners[(k + 1) % corners.size()];
    for (std::size_t i = corners[k]; side.empty() || i != end; i = (i + 1) % loop.size())
      side.push_back(loop[i].curve);
  }
  return mapped;
}

bool sides_match(double a, double b) {
  return std::abs(a - b) <= 1 || std::max(a, b) <= kMostSideRatio * std::min(a, b);
}

bool is_narrow(double width, double length) { return width <= kNarrow && length > kNarrow; }

/// Whether a grid pays there; `just_narrow`: as a strip.
bool looks_mapped(const Loop& loop, const std::vector<std::size_t>& corners, bool just_narrow) {
  if (corners.size() != 4) return false;
  std::array<double, 4> ideal{};
  std::size_t side = 3;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto at = std::ranges::find(corners, i);
    const bool is_corner = at != corners.end();
    if (is_corner) side = static_cast<std::size_t>(at - corners.begin());
    if (turn_from(loop[i], is_corner ? 90 : 180) > (is_corner ? kCornerSlack : kStraightSlack)) return false;
    ideal[side] += loop[i].ideal;
  }
  const auto [width, length] = std::minmax({(ideal[0] + ideal[2]) / 2, (ideal[1] + ideal[3]) / 2});
  if (just_narrow && !is_narrow(width, length)) return false;
  return sides_match(ideal[0], ideal[2]) && sides_match(ideal[1], ideal[3]);
}

bool turns_nowhere(const Loop& loop) {
  return std::ranges::all_of(loop, [](const OutlinePart& p) { return turn_from(p, 180) <= kStraightSlack; });
}

double wanted(const Loop& loop) {
  double ideal = 0;
  for (const OutlinePart& part : loop) ideal += part.ideal;
  return ideal;
}

std::string place_text(const Vec3& x) { return x.z == 0 ? show_point(Vec2{x.x, x.y}) : show_point(x); }

/// Why a named face is no grid.
std::string why_no_grid(const FaceOutline& outline) {
  if (outline.size() != 1)
    return "something lies inside of it: expected one outline, or two without corners, a ring";
  return fmt::format("its outline has {} corner(s): expected at least 3", outline[0].size());
}

}  // namespace

GridFinder::GridFinder(const MappedSpec& spec, const std::vector<Entity>& regions, const NamedPlaces& points)
    : spec_(spec) {
  const auto check_name = [&](const std::string& where, const std::string& name) {
    std::vector<std::string> known;
    for (const Entity& region : regions) {
      if (has_name(region, name)) return;
      known.push_back(region_label(region));
    }
    throw InputError(fmt::format("{}: no region is called '{}'{} [unknown-name]", where, name,
                                 suggestion_or_all(name, known)));
  };
  for (const std::string& name : spec.names) check_name(spec.where, name);
  for (const GridCorners& asked : spec.corners) {
    check_name(asked.where, asked.region);
    if (asked.corners.size() != 3 && asked.corners.size() != 4)
      throw InputError(fmt::format("{}: '{}' is given {} corner(s): expected 3 or 4", asked.where,
                                   asked.region, asked.corners.size()));
    Corners& requested = corners_.emplace_back(Corners{&asked, {}, false, {}});
    for (const GridCorner& corner : asked.corners) {
      if (corner.name.empty()) {
        requested.at.push_back(corner.at);
        continue;
      }
      const auto point = std::ranges::find(points, corner.name, &NamedPlaces::value_type::first);
      if (point == points.end()) {
        std::vector<std::string> known;
        for (const auto& [name, at] : points) known.push_back(name);
        throw InputError(fmt::format("{}: no point is called '{}'{} [unknown-name]", asked.where, corner.name,
                                     suggestion_or_all(corner.name, known)));
      }
      requested.at.push_back(point->second);
    }
  }
}

std::vector<std::size_t> GridFinder::requested_corners(const Entity& region, const FaceOutline& outline) {
  for (Corners& requested : corners_) {
    if (!has_name(region, requested.asked->region) || outline.size() != 1) continue;
    Box<Vec3> box{outline[0][0].at, outline[0][0].at};
    for (const OutlinePart& part : outline[0]) box.add(part.at);
    const double reach = kCornerReach * norm(box.size());
    std::vector<std::size_t> corners;
    for (const Vec3& at : requested.at) {
      std::size_t nearest = 0;
      for (std::size_t i = 1; i < outline[0].size(); ++i)
        if (norm(outline[0][i].at - at) < norm(outline[0][nearest].at - at)) nearest = i;
      const Vec3& node = outline[0][nearest].at;
      if (norm(node - at) > reach) {
        requested.missing = fmt::format(
            "{} is no node of the outline of '{}', where curves end, meet or turn: the "
            "nearest is {}",
            place_text(at), region_label(region), place_text(node));
        break;
      }
      if (std::ranges::find(corners, nearest) != corners.end()) {
        requested.missing = fmt::format("{} is a corner of '{}' twice", place_text(at), region_label(region));
        break;
      }
      corners.push_back(nearest);
    }
    if (corners.size() < requested.at.size()) continue;
    requested.is_used = true;
    std::ranges::sort(corners);
    return corners;
  }
  return {};
}

std::optional<MappedFace> GridFinder::find(int face, const Entity& region, const FaceOutline& outline,
                                           double quads) {
  if (const auto corners = requested_corners(region, outline); !corners.empty())
    return cut_at(face, outline[0], corners);
  const bool asked =
      std::ranges::any_of(spec_.names, [&](const auto& name) { return has_name(region, name); });
  const auto requested =
      std::ranges::find_if(spec_.rings, [&](const auto& r) { return has_name(region, r.first); });
  const int rows = requested == spec_.rings.end() ? 0 : requested->second;
  const bool just_narrow = !asked && !spec_.automatic && rows == 0;
  if (outline.size() == 2 && (rows > 0 || (turns_nowhere(outline[0]) && turns_nowhere(outline[1])))) {
    const double outer = wanted(outline[0]), inner = wanted(outline[1]);
    if (!asked && rows == 0 && !sides_match(outer, inner)) return std::nullopt;
    const double length = (outer + inner) / 2;
    if (just_narrow && rows == 0 && !is_narrow(quads / length, length)) return std::nullopt;
    MappedFace ring{face, asked, {{}, {}}, {}, rows};
    for (const int k : {0, 1})
      for (const OutlinePart& part : outline[k]) ring.sides[k].push_back(part.curve);
    return ring;
  }
  if (outline.size() != 1 || outline[0].size() < 3 || rows > 0) {
    if (!asked) return std::nullopt;
    throw InputError(fmt::format("{}: '{}' cannot be a grid: {} [no-grid]", spec_.where, region_label(region),
                                 why_no_grid(outline)));
  }
  const std::vector<std::size_t> corners = corners_by_angle(outline[0]);
  if (!asked && !looks_mapped(outline[0], corners, just_narrow)) return std::nullopt;
  MappedFace mapped = cut_at(face, outline[0], corners);
  mapped.is_requested = asked, mapped.rows = rows;
  return mapped;
}

void GridFinder::finish() const {
  for (const Corners& requested : corners_)
    if (!requested.is_used)
      throw InputError(fmt::format(
          "{}: {}", requested.asked->where,
          requested.missing.empty()
              ? fmt::format("'{}' cannot be a grid: {} [no-grid]", requested.asked->region, why_no_grid({}))
              : requested.missing));
}

namespace {

/// How far the numbers of edges of a face's curves are from what these want, as a ratio; 1: near enough.
double change_of(const MappedFace& face, const std::vector<CountedCurve>& curves,
                 const std::vector<int>& leader) {
  double most = 1;
  for (const auto& side : face.sides)
    for (const int c : side) {
      const CountedCurve& curve = curves[leader[c]];
      if (std::abs(curve.n - curve.ideal) <= 1 || !curve.is_free) continue;
      most = std::max({most, curve.n / curve.ideal, curve.ideal / curve.n});
    }
  return most;
}

/// Takes out what was not asked for and has curves that are changed too much; of faces beside each other the
/// worst. False: there is none.
bool drop_changed(std::vector<MappedFace>& mapped, const std::vector<CountedCurve>& curves,
                  const std::vector<int>& leader) {
  std::vector<std::pair<double, int>> changed;
  for (const MappedFace& m : mapped)
    if (const double change = change_of(m, curves, leader); !m.is_requested && change > kMostChange)
      changed.emplace_back(-change, m.face);
  std::ranges::sort(changed);
  std::vector<char> is_touched(curves.size(), 0);
  for (const auto& [change, f] : changed) {
    const auto face = std::ranges::find(mapped, f, &MappedFace::face);
    bool is_alone = true;
    for (const auto& side : face->sides)
      for (const int c : side) is_alone &= is_touched[leader[c]] == 0;
    for (const auto& side : face->sides)
      for (const int c : side) is_touched[leader[c]] = 1;
    if (is_alone) mapped.erase(face);
  }
  return !changed.empty();
}

}  // namespace

std::vector<UnbalancedFace> balance_grids(std::vector<CountedCurve>& curves,
                                          const std::vector<std::vector<int>>& around,
                                          const std::vector<int>& leader, std::vector<MappedFace>& mapped) {
  const auto begin = curves;
  for (;;) {
    std::vector<CountedFace> faces(around.size());
    for (std::size_t f = 0; f < around.size(); ++f) faces[f].sides[0] = around[f];
    for (const MappedFace& m : mapped) {
      CountedFace& face = faces[m.face];
      face = {};
      // A ring is as a face whose other two sides match.
      face.n_sides = m.sides.size() == 3 ? 3 : 4;
      for (std::size_t k = 0; k < m.sides.size(); ++k)
        for (const int curve : m.sides[k])
          face.sides[m.sides.size() == 2 ? 2 * k : k].push_back(leader[curve]);
    }
    auto bad = balance_counts(curves, faces);
    const auto is_bad = [&](const MappedFace& m) {
      return !m.is_requested &&
             std::ranges::any_of(bad, [&](const UnbalancedFace& b) { return b.face == m.face; });
    };
    if (bad.empty() && !drop_changed(mapped, curves, leader)) return bad;
    if (!bad.empty() && std::erase_if(mapped, is_bad) == 0 &&
        std::erase_if(mapped, [](const MappedFace& m) { return !m.is_requested; }) == 0)
      return bad;
    curves = begin;
  }
}

std::string why_unbalanced(const UnbalancedFace& bad, const std::string& label, const MappedFace* mapped,
                           const std::vector<CountedCurve>& curves, const std::vector<std::string>& names) {
  std::string what = "with an odd number around it, and quads need an even one";
  if (mapped != nullptr && mapped->sides.size() != 3)
    what = "with sides that do not match, and a grid needs equal numbers on opposite sides";
  if (mapped != nullptr && mapped->sides.size() == 3) {
    std::array<int, 3> n{};
    for (const int k : {0, 1, 2})
      for (const int curve : mapped->sides[k]) n[k] += curves[curve].n;
    what = fmt::format(
        "with sides of {}, {} and {} edges, and grids around a middle need an even sum and each less than "
        "the "
        "two others together",
        n[0], n[1], n[2]);
  }
  std::vector<std::string> fixed;
  for (const int curve : bad.fixed) {
    const std::string text = fmt::format("'{}' ({} edges)", names[curve], curves[curve].n);
    if (std::ranges::find(fixed, text) == fixed.end()) fixed.push_back(text);
  }
  if (fixed.empty())
    return fmt::format("the numbers of edges of its curves leave '{}' {} [odd-numbers]", label, what);
  if (fixed.size() > kMostCurvesNamed) fixed.resize(kMostCurvesNamed);
  return fmt::format(
      "the given numbers of edges leave '{}' {}. Change or leave out the number on {} [odd-numbers]", label,
      what, fmt::join(fixed, " or "));
}

}  // namespace delquad
