// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/criteria.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();
constexpr const char* kInSizes = "size";
/// Limits of stages are at most as strict as this, for sizes vary in any mesh.
constexpr double kMostShort = 0.7, kLeastLong = 1.5, kLeastAspect = 2, kMostEta = 0.6;

/// Returns the limit of a key that counts for elements with the name; null: none.
const CriterionLimit* find_limit(const Criteria& criteria, CriterionKind kind, const std::string& on) {
  const CriterionLimit* found = nullptr;
  for (const CriterionLimit& limit : criteria.limits)
    if (limit.key == criterion_registry()[kind].key && (limit.on == on || (limit.on.empty() && !found)))
      found = &limit;
  return found;
}

void check_pairs(const Criteria& criteria, const std::string& on) {
  constexpr std::pair<CriterionKind, CriterionKind> kPairs[] = {
      {kMinLength, kMaxLength}, {kMinHeight, kMaxLength}, {kMinAngle, kMaxAngle}};
  for (const auto& [low, high] : kPairs) {
    const CriterionLimit *least = find_limit(criteria, low, on), *most = find_limit(criteria, high, on);
    if (least && most && least->in_sizes == most->in_sizes && least->value > most->value)
      refuse("{}: '{}' is {}, but '{}' {} ({}): no element is within both", least->where, least->key,
             text_of(*least), most->key, text_of(*most), most->where);
  }
}

/// Returns the names of entities, each once.
std::vector<std::string> names_of(const Mesh& mesh) {
  std::set<std::string> names;
  for (const auto* entities : {&mesh.curves, &mesh.regions})
    for (const Entity& entity : *entities) names.insert(entity.names.begin(), entity.names.end());
  return {names.begin(), names.end()};
}

Criteria preset(const char* name, const char* source,
                std::initializer_list<std::pair<const char*, std::string>> limits) {
  Criteria criteria{.name = name, .source = source, .where = fmt::format("criteria '{}'", name)};
  for (const auto& [key, value] : limits) criteria.set(key, value, "", criteria.where);
  return criteria;
}

}  // namespace

const std::vector<Criterion>& criterion_registry() {
  static const std::vector<Criterion> all = {
      {"min_length", "a side shorter than", "", false, 0, kMost, true, "Verdict, edge lengths"},
      {"max_length", "a side longer than", "", true, 0, kMost, true, "Verdict, edge lengths"},
      {"min_height", "a height below", "", false, 0, kMost, true,
       "HyperMesh, length (min) as minimal normalized height"},
      {"max_aspect", "an aspect above", "", true, 1, kMost, false, "Verdict, edge ratio"},
      {"min_angle", "an angle below", " degrees", false, 0, 90, false, "Verdict, minimum angle"},
      {"max_angle", "an angle above", " degrees", true, 90, 180, false, "Verdict, maximum angle"},
      {"max_warpage", "a warpage above", " degrees", true, 0, 180, false,
       "HyperMesh, warpage: the larger of both diagonals'"},
      {"min_jacobian", "a scaled Jacobian below", "", false, 0, 1, false, "Verdict, scaled Jacobian"},
      {"min_jacobian_ratio", "a ratio of Jacobians at Gauss points below", "", false, 0, 1, false,
       "HyperMesh, Jacobian at integration points"},
      {"max_skew", "a skew above", " degrees", true, 0, 90, false, "HyperMesh and OptiStruct, skew of quads"},
      {"max_taper", "a taper above", "", true, 0, 1, false, "HyperMesh, taper"},
      {"min_time_step", "a time step below", "", false, 0, kMost, false,
       "length of LS-DYNA, Radioss or Abaqus/Explicit over the speed of sound"},
      {"min_eta", "an eta below", "", false, 0, 1, false, "paper, equation (4)"}};
  return all;
}

CriterionKind criterion_kind(const std::string& key) {
  std::vector<std::string> known;
  for (const Criterion& criterion : criterion_registry()) known.push_back(criterion.key);
  const auto at = std::ranges::find(known, key);
  if (at == known.end())
    refuse("unknown criterion '{}': expected one of {}{}", key, fmt::join(known, ", "),
           suggestion(key, known));
  return static_cast<CriterionKind>(at - known.begin());
}

double times_beyond(CriterionKind kind, double value, double limit) {
  const auto positive = [](double x) { return std::max(x, 1e-300); };
  if (limit == 0) return value < 0 ? kMost : 0;
  if (kind == kMaxAngle) return (180 - limit) / positive(180 - value);
  return criterion_registry()[kind].is_most ? value / limit : limit / positive(value);
}

std::function<double(const std::array<Vec3, 4>&, double)> excess_of(const Criteria& criteria) {
  constexpr double kMargin = 0.02;
  std::vector<std::pair<CriterionKind, CriterionLimit>> limits;
  for (const CriterionLimit& limit : criteria.limits)
    if (limit.on.empty()) limits.emplace_back(criterion_kind(limit.key), limit);
  return [limits, by = step_length_named(criteria.time_step_by), speed = speed_of_sound(criteria)](
             const std::array<Vec3, 4>& corners, double size) {
    const ElementShape<4> shape = element_shape(corners, area_vector(corners));
    double sum = 0;
    for (const auto& [kind, limit] : limits) {
      const double value = criterion_value(kind, corners, shape, by, speed) / (limit.in_sizes ? size : 1);
      sum += std::max(0.0, std::log(std::max(times_beyond(kind, value, limit.value), 1e-300)) + kMargin);
    }
    return sum;
  };
}

const CriterionLimit* least_length(const Criteria& criteria) { return find_limit(criteria, kMinLength, ""); }

QuadLimits limits_of(const Criteria& criteria, const SizeField& size, std::span<const Vec3> points) {
  if (criteria.empty()) return {};
  double most = 0;
  int hint = -1;
  for (const Vec3& x : points) most = std::max(most, size.at(x, hint));
  const auto limit_of = [&](CriterionKind kind, double otherwise) {
    const CriterionLimit* limit = find_limit(criteria, kind, "");
    if (limit == nullptr) return otherwise;
    return criterion_registry()[kind].of_length && !limit->in_sizes ? limit->value / most : limit->value;
  };
  QuadLimits limits;
  limits.shortest = std::clamp(limit_of(kMinLength, 0), limits.shortest, kMostShort);
  limits.longest = std::clamp(limit_of(kMaxLength, kMost), kLeastLong, limits.longest);
  limits.aspect = std::clamp(limit_of(kMaxAspect, kMost), kLeastAspect, limits.aspect);
  limits.eta = std::clamp(std::max(limit_of(kMinAngle, 0) / 90, 2 - limit_of(kMaxAngle, 180) / 90),
                          limits.eta, kMostEta);
  return limits;
}

StepLength step_length_named(const std::string& name) {
  const auto* at = std::ranges::find(kStepLengths, name);
  if (at == std::end(kStepLengths))
    refuse("time_step_by is '{}': expected {}", name, fmt::join(kStepLengths, ", "));
  return static_cast<StepLength>(at - kStepLengths);
}

double speed_of_sound(const Criteria& criteria) {
  if (!criteria.material) return 1;
  const auto& [young, poisson, density] = *criteria.material;
  return std::sqrt(young / (density * (1 - poisson * poisson)));
}

std::string text_of(const CriterionLimit& limit) {
  return fmt::format("{:.6g}{}", limit.value,
                     limit.in_sizes ? " size" : criterion_registry()[criterion_kind(limit.key)].unit);
}

Criteria& Criteria::set(const std::string& key, const std::string& value, const std::string& on,
                        const std::string& set_where) {
  located(set_where, [&] {
    const Criterion& criterion = criterion_registry()[criterion_kind(key)];
    std::string_view number = trimmed(value);
    const bool in_sizes = criterion.of_length && number.ends_with(kInSizes);
    if (in_sizes) number = trimmed(number.substr(0, number.size() - std::string_view(kInSizes).size()));
    const auto read = as_number(number);
    const bool above_zero = criterion.least == 0 && (criterion.is_most || criterion.most == kMost);
    if (!read || !(*read >= criterion.least) || !(*read <= criterion.most) || (above_zero && *read == 0))
      refuse("'{}' is '{}': expected a number {} {}{}{}", key, value, above_zero ? "above" : "from",
             criterion.least,
             criterion.most < kMost
                 ? fmt::format("{} {}{}", above_zero ? ", at most" : " to", criterion.most, criterion.unit)
                 : "",
             criterion.of_length ? ", or parts of the size such as \"0.33 size\"" : "");
    if (in_sizes && (criterion.is_most ? *read < 1 : *read > 1))
      refuse("'{}' is {} size: {} the wanted size itself", key, *read, criterion.is_most ? "below" : "above");
    std::erase_if(limits, [&](const CriterionLimit& old) { return old.key == key && old.on == on; });
    limits.push_back({key, *read, in_sizes, on, set_where});
  });
  return *this;
}

const std::vector<Criteria>& criteria_presets() {
  const QuadLimits usual;
  static const std::vector<Criteria> all = {
      preset("batch",
             "Lengths and warpage: Altair, BatchMesher, Guidelines and Recommended Practices (2017). Aspect: "
             "Altair, HyperMesh, Element Quality Calculations. Angles and Jacobian at corners: Siemens, NX "
             "Open, sample criteria of its batch mesher",
             {{"min_length", fmt::format("{} size", usual.shortest)},
              {"max_length", fmt::format("{} size", usual.longest)},
              {"max_aspect", fmt::format("{}", usual.aspect)},
              {"min_angle", fmt::format("{}", 90 * usual.eta)},
              {"max_angle", fmt::format("{}", 180 - 90 * usual.eta)},
              {"max_warpage", "20"},
              {"min_jacobian", "0.5"}}),
      preset("crash",
             "Lengths and aspect: Altair, HyperMesh 2021, *rebuild_mesh, example of 5 mm criteria. Other "
             "limits: Siemens, NX Open, sample criteria of its batch mesher for closures of cars at 12 mm",
             {{"min_length", "0.6 size"},
              {"max_length", "1.8 size"},
              {"max_aspect", "5"},
              {"min_angle", "40"},
              {"max_angle", "140"},
              {"max_warpage", "15"},
              {"max_skew", "60"},
              {"min_jacobian_ratio", "0.5"}}),
      preset("static",
             "Angles: Altair, OptiStruct, CQUAD4 Element Check, warnings. Other limits: Altair, Engineering "
             "Solutions 2021, Global Model Validation",
             {{"max_aspect", "5"},
              {"min_angle", "15"},
              {"max_angle", "165"},
              {"max_warpage", "10"},
              {"max_skew", "60"},
              {"max_taper", "0.8"}})};
  return all;
}

void check_criteria(const Criteria& criteria) {
  if (criteria.limits.size() > kMostLimits)
    refuse("{}: {} limits: expected at most {}", criteria.where, criteria.limits.size(), kMostLimits);
  std::set<std::string> names = {""};
  for (const CriterionLimit& limit : criteria.limits) {
    names.insert(limit.on);
    if (limit.key == criterion_registry()[kMinTimeStep].key && !criteria.material)
      throw InputError(limit.where +
                       ": 'min_time_step' needs a material: expected 'material' with 'young', "
                       "'poisson' and 'density'");
  }
  for (const std::string& name : names) check_pairs(criteria, name);
  located(criteria.where, [&] {
    step_length_named(criteria.time_step_by);
    if (!criteria.material) return;
    const auto& [young, poisson, density] = *criteria.material;
    if (!(young > 0) || !(density > 0) || !(poisson >= 0 && poisson <= 0.5) ||
        !std::isfinite(young / density))
      refuse(
          "the material has young {}, poisson {} and density {}: expected 'young' and 'density' above 0, "
          "'poisson' from 0 to 0.5",
          young, poisson, density);
  });
}

void check_criteria(const Criteria& criteria, const Mesh& mesh, const SizeField& size) {
  if (criteria.empty()) return;
  const std::vector<std::string> known = names_of(mesh);
  double least = kMost, most = 0;
  int hint = -1;
  for (const Vec3& x : mesh.points) {
    const double here = size.at(x, hint);
    least = std::min(least, here), most = std::max(most, here);
  }
  for (const CriterionLimit& limit : criteria.limits) {
    if (!limit.on.empty() && std::ranges::find(known, limit.on) == known.end())
      refuse("{}: no curve and no region is called '{}'{} [unknown-name]", limit.where, limit.on,
             suggestion_or_all(limit.on, known));
    const CriterionKind kind = criterion_kind(limit.key);
    const Criterion& criterion = criterion_registry()[kind];
    if ((!criterion.of_length && kind != kMinTimeStep) || limit.in_sizes) continue;
    const double length = kind == kMinTimeStep ? limit.value * speed_of_sound(criteria) : limit.value;
    if (criterion.is_most ? length < least : length > most)
      refuse("{}: '{}' is {}{}, but the wanted size is {:.6g} {}", limit.where, limit.key, limit.value,
             kind == kMinTimeStep ? fmt::format(", over a length of {:.6g}", length) : "",
             criterion.is_most ? least : most, criterion.is_most ? "and more" : "at most");
  }
}

const std::vector<Metric>& criteria_metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> metrics = {
        {"failing", "failing", "%", Better::kLower, 100, "elements beyond a limit of the criteria", 2}};
    for (const Criterion& c : criterion_registry())
      metrics.push_back({"failing_" + c.key, "failing " + c.key, "%", Better::kLower, 100,
                         fmt::format("elements with {} the limit ({})", c.fails, c.source), 2});
    metrics.push_back({"time_step", "time step", "", Better::kHigher, 0,
                       "critical time step, divided by the time step of squares of the least wanted size",
                       3});
    return metrics;
  }();
  return all;
}

std::map<std::string, double> values_of(const CriteriaReport& report) {
  const auto percent = [&](std::size_t n) {
    return report.elements > 0 ? 100 * static_cast<double>(n) / static_cast<double>(report.elements) : 0;
  };
  std::map<std::string, double> values = {{"failing", percent(static_cast<std::size_t>(report.failing))},
                                          {"time_step", report.critical_step / report.step_of_squares}};
  std::map<std::string, std::set<int>> failing;
  for (const CriterionResult& result : report.results)
    failing["failing_" + result.limit.key].insert(result.failing.begin(), result.failing.end());
  for (const auto& [key, elements] : failing) values[key] = percent(elements.size());
  return values;
}

}  // namespace delquad
