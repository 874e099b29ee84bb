// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/naming/name_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/box.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

/// Tolerance in parts of the model's diagonal, for boxes and for equally near places.
constexpr double kRoundOff = 1e-6;
/// Faces look the way that is asked for where all of their normals are within this of it.
const double kLeastCosine = std::cos(5 * std::numbers::pi / 180);

/// Whether a text fits `pattern`: * stands for any text, ? for one character. After a failure the last *
/// takes one character more.
bool fits(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, taken = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*')
      star = p++, taken = t;
    else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t]))
      ++p, ++t;
    else if (star != std::string_view::npos)
      p = star + 1, t = ++taken;
    else
      return false;
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// The faces or the curves of a model, with what they are made of.
class Parts {
 public:
  Parts(const Mesh& fine, bool curves) : fine_(fine), curves_(curves), elements_(entities().size()) {
    const std::vector<int>& of = curves ? fine.line_curve : fine.triangle_region;
    for (std::size_t i = 0; i < of.size(); ++i) elements_[of[i]].push_back(static_cast<int>(i));
  }

  const std::vector<Entity>& entities() const { return curves_ ? fine_.curves : fine_.regions; }

  bool is_in(int part, const Box<Vec3>& box) const {
    return all_of(part, [&](int element) {
      return std::ranges::all_of(corners(element),
                                 [&](int v) { return box.distance2(fine_.points[v]) == 0; });
    });
  }
  bool looks_along(int part, const Vec3& normal) const {
    return all_of(part, [&](int t) {
      const auto& [a, b, c] = fine_.triangles[t];
      const Vec3 n = cross(fine_.points[b] - fine_.points[a], fine_.points[c] - fine_.points[a]);
      return dot(n, normal) >= kLeastCosine * norm(n) * norm(normal);
    });
  }
  double distance(int part, const Vec3& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const int element : elements_[part]) least = std::min(least, distance_to(element, x));
    return least;
  }

 private:
  std::span<const int> corners(int element) const {
    if (curves_) return fine_.lines[element];
    return fine_.triangles[element];
  }
  template <class Test>
  bool all_of(int part, Test test) const {
    return !elements_[part].empty() && std::ranges::all_of(elements_[part], test);
  }
  double distance_to(int element, const Vec3& x) const {
    const auto v = corners(element);
    const auto at = [&](int k) { return fine_.points[v[k]]; };
    if (curves_) return distance_to_segment(x, at(0), at(1));
    const auto w = nearest_weights(at(0), at(1), at(2), x);
    return norm(w[0] * at(0) + w[1] * at(1) + w[2] * at(2) - x);
  }

  const Mesh& fine_;
  const bool curves_;
  std::vector<std::vector<int>> elements_;  ///< by part
};

/// A rule, and what messages call it.
struct Request {
  const PartRule& rule;
  bool curves;
  std::string what, where;  ///< "the name 'load'"
};

/// The part among these that is nearest to x; throws where there are two.
int nearest_of(const std::vector<int>& found, const Parts& parts, const Request& asked, double tolerance) {
  double least = std::numeric_limits<double>::infinity();
  int best = found[0], other = -1;
  for (const int i : found) {
    const double distance = parts.distance(i, *asked.rule.at);
    if (distance < least - tolerance)
      best = i, other = -1, least = distance;
    else if (distance <= least + tolerance && i != best)
      other = i;
  }
  if (other >= 0)
    throw InputError(
        fmt::format("{}: {} {} and {} are as near to {} as each other: expected a place nearer to one "
                    "[two-parts-for-a-name]",
                    asked.where, asked.curves ? "curves" : "faces", parts.entities()[best].tag,
                    parts.entities()[other].tag, show_point(*asked.rule.at)));
  return best;
}

std::vector<int> find(const Request& asked, const Mesh& fine) {
  const PartRule& rule = asked.rule;
  if (rule.numbers.empty() && rule.like.empty() && !rule.box && !rule.normal && !rule.at)
    throw InputError(
        fmt::format("{}: nothing says what {} is: expected numbers, names, a box, a normal or a place",
                    asked.where, asked.what));
  for (const auto& place : {rule.at, rule.normal, rule.box ? std::optional((*rule.box)[0]) : std::nullopt,
                            rule.box ? std::optional((*rule.box)[1]) : std::nullopt})
    if (place && !std::isfinite(place->x + place->y + place->z))
      throw InputError(fmt::format("{}: {} has a coordinate that is not finite", asked.where, asked.what));
  if (rule.normal && (asked.curves || !(norm(*rule.normal) > 0)))
    throw InputError(asked.where +
                     (asked.curves ? ": curves have no normals" : ": the normal has no length"));
  const Parts parts(fine, asked.curves);
  const std::vector<Entity>& all = parts.entities();
  const double tolerance = kRoundOff * diagonal(fine);
  for (const int number : rule.numbers)
    if (std::ranges::find(all, number, &Entity::tag) == all.end())
      throw InputError(fmt::format("{}: there is no {} {}: expected a number of 'delquad info'", asked.where,
                                   asked.curves ? "curve" : "face", number));
  std::vector<int> found;
  for (int i = 0; i < static_cast<int>(all.size()); ++i) {
    if (!rule.numbers.empty() && std::ranges::find(rule.numbers, all[i].tag) == rule.numbers.end()) continue;
    if (!rule.like.empty() &&
        std::ranges::none_of(all[i].names, [&](const std::string& name) { return fits(rule.like, name); }))
      continue;
    if (rule.box && !parts.is_in(i, {lower((*rule.box)[0], (*rule.box)[1]) - tolerance * Vec3{1, 1, 1},
                                     upper((*rule.box)[0], (*rule.box)[1]) + tolerance * Vec3{1, 1, 1}}))
      continue;
    if (rule.normal && !parts.looks_along(i, *rule.normal)) continue;
    found.push_back(i);
  }
  if (found.empty())
    throw InputError(fmt::format("{}: no {} of the {} fits the rule for {} [no-part-for-a-name]", asked.where,
                                 asked.curves ? "curve" : "face", all.size(), asked.what));
  if (rule.at) found = {nearest_of(found, parts, asked, tolerance)};
  return found;
}

}  // namespace

void name_parts(const std::vector<NamedPart>& parts, SurfaceModel& model) {
  for (const NamedPart& asked : parts) {
    if (asked.name.empty()) throw InputError(asked.where + ": a part without a name: expected one");
    const Request request = {asked.rule, asked.curves, fmt::format("the name '{}'", asked.name), asked.where};
    for (const int i : find(request, model.fine)) {
      std::vector<std::string>& names = (asked.curves ? model.fine.curves : model.fine.regions)[i].names;
      if (std::ranges::find(names, asked.name) == names.end()) names.push_back(asked.name);
    }
  }
}

std::vector<int> selected_faces(const std::vector<PartRule>& rules, const std::string& where,
                                const Mesh& fine) {
  std::vector<int> faces;
  for (const PartRule& rule : rules) {
    const bool is_name = !rule.like.empty() && rule.like.find_first_of("*?") == std::string::npos;
    const std::vector<int> found = is_name && rule.numbers.empty() && !rule.box && !rule.normal && !rule.at
                                       ? find_entities(fine.regions, "region", rule.like, where)
                                       : find({rule, false, "'faces'", where}, fine);
    faces.insert(faces.end(), found.begin(), found.end());
  }
  sort_unique(faces);
  return faces;
}

}  // namespace delquad
