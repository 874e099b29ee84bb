// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/check_described.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "algorithms/fields/fields.h"
#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

bool has_limits(const Rule& rule) { return rule.least || rule.above || rule.most; }

bool is_inside(const Rule& rule, double value) {
  return std::isfinite(value) && value >= rule.least.value_or(value) && value <= rule.most.value_or(value) &&
         (!rule.above || value > *rule.above);
}

std::string expected_number(const Rule& rule) {
  if (rule.above && rule.most) return fmt::format("above {} and at most {}", *rule.above, *rule.most);
  if (rule.above) return fmt::format("a number above {}", *rule.above);
  if (rule.least && rule.most) return fmt::format("{} to {}", *rule.least, *rule.most);
  if (rule.least) return fmt::format("at least {}", *rule.least);
  return rule.most ? fmt::format("at most {}", *rule.most) : "a finite number";
}

/// Refuses a range that begins with the larger number. `numbers`: its name.
void check_range(double least, double most, const char* numbers, const std::string& where) {
  if (least > most)
    refuse("{}: {} from {} to {}: expected two lengths, the lesser first", where, numbers, least, most);
}

}  // namespace

std::string ValueName::text() const {
  return fmt::format("{}: '{}'{}", where, key, owner.empty() ? "" : " of '" + owner + "'");
}

void check_number(double value, const Rule& rule, const ValueName& name, std::optional<double> none) {
  if ((rule.form == Form::kNone && !has_limits(rule)) || is_inside(rule, value)) return;
  refuse("{} is {}: expected {}{}", name.text(), value, expected_number(rule),
         none && !is_inside(rule, *none) ? fmt::format(", or {} for none", *none) : "");
}

void check_text(const std::string& text, const Rule& rule, const ValueName& name) {
  if (text.empty() && rule.required) refuse_empty(name);
  if (rule.form == Form::kGroup && !fits_msh(text))
    refuse("{} is a name of a mesh file: expected one without double quotes and line breaks", name.text());
  if (text.empty() || rule.words == nullptr) return;
  const std::vector<std::string> words = words_of(rule.words);
  if (std::ranges::find(words, text) == words.end())
    refuse("{} is '{}': expected {}{}", name.text(), text, fmt::join(words, ", "), suggestion(text, words));
}

void check_vector(const Vec3& vector, const Rule& rule, const ValueName& name) {
  if (rule.form == Form::kNone) return;
  if (!std::isfinite(norm(vector))) refuse("{} is not finite: expected finite numbers", name.text());
  if (rule.above && !(norm(vector) > *rule.above))
    refuse("{} has no length: expected a vector of another length than 0", name.text());
}

void check_unique(const std::vector<std::string>& texts, const ValueName& name) {
  for (const std::string& text : texts)
    if (std::ranges::count(texts, text) > 1)
      refuse("{} has '{}' twice: expected each text once", name.text(), text);
}

void check_length(std::size_t length, double least, const ValueName& name) {
  if (length == 0) refuse_empty(name);
  if (static_cast<double>(length) < least)
    refuse("{} has {}: expected at least {}", name.text(), counted(length, "value"), least);
}

void refuse_empty(const ValueName& name) { refuse("{} is empty: expected a value", name.text()); }

void check_together(const SizeSource& source, const std::string& where) {
  if (source.radius_far <= source.radius_near)
    refuse("{}: 'radius_far' must be larger than 'radius_near'", where);
}

void check_together(const NamedSize& named, const std::string& where) {
  if (named.size == 0 && named.curvature == 0)
    refuse("{}: '{}' gets no size: expected 'size' or 'curvature'", where, named.name);
}

void check_together(const SizeSpec& size, const std::string& where) {
  if ((size.field != nullptr) + (size.function != nullptr) + size.from_boundary > 1)
    refuse("{}: a size is a field, a function or the boundary's: expected one of them", where);
  if (size.min > 0 && !follows_curvature(size))
    refuse("{}: a least size is for sizes that follow curvature: expected 'curvature' too", where);
  if (size.min > 0 && size.max > 0 && size.min > size.max)
    refuse("{}: the least size {} is larger than the largest, {}", where, size.min, size.max);
}

void check_together(const MetricSpec& metric, const std::string& where) {
  if (!metric.tensor.empty() + !metric.sizes.empty() + !metric.solution.empty() + !metric.file.empty() +
          (metric.chord > 0) >
      1)
    refuse("{}: expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord'", where);
  if (metric.limits.max > 0 && metric.limits.min > metric.limits.max)
    refuse("{}: 'min' is larger than 'max'", where);
}

void check_together(const LayerSpec& layer, const std::string&) { layer_heights(layer); }

void check_together(const SurfaceSpec& surface, const std::string& where) {
  if (surface.compounds != Compounds::kGroups) return;
  if (surface.groups.empty())
    refuse("{}: compounds by groups have no group: expected 'faces', a list of lists", where);
  for (const auto& group : surface.groups)
    if (group.size() < 2) refuse("{}: a compound of fewer than two faces: expected two or more", where);
}

void check_together(const WasherSpec& washer, const std::string& where) {
  check_range(washer.least, washer.most, "diameters", where);
  if (washer.edges % 2 != 0)
    refuse("{}: {} edges around holes: expected an even number", where, washer.edges);
}

void check_together(const FilletRows& rows, const std::string& where) {
  check_range(rows.least, rows.most, "radii", where);
}

}  // namespace delquad
