// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/read_record.h"

#include <cstdio>
#include <span>

#include "delquad/error.h"

namespace delquad {
namespace {

/// The numbers of a text with blanks between them.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  const std::string all(text);
  double number = 0;
  for (int at = 0, length = 0; std::sscanf(all.c_str() + at, "%lf%n", &number, &length) == 1; at += length)
    numbers.push_back(number);
  return numbers;
}

std::vector<Vec2> points_of(std::span<const double> numbers) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) points.push_back({numbers[i], numbers[i + 1]});
  return points;
}

/// The curve with this DefinedCurve::definition(). Null: there is none.
std::shared_ptr<const Curve> curve_of(const std::string& definition) {
  const std::string kind = definition.substr(0, definition.find(' '));
  const std::vector<double> n = numbers_in(std::string_view(definition).substr(kind.size()));
  if (kind == "polyline") return make_polyline(points_of(n));
  if (kind == "arc" && n.size() == 5) return make_arc({n[0], n[1]}, n[2], n[3], n[4]);
  if (const auto corner = definition.rfind(" corner "); kind == "spline" && corner != definition.npos)
    return make_spline(points_of(n), numbers_in(std::string_view(definition).substr(corner + 8)).at(0));
  // "'X' 'Y' from A to B"
  const std::size_t x = definition.find('\'', 1), y = definition.rfind('\'');
  double from = 0, to = 0;
  if (definition.starts_with('\'') && x + 3 < y &&
      std::sscanf(definition.c_str() + y, "' from %lf to %lf", &from, &to) == 2)
    return make_expression_curve(definition.substr(1, x - 1), definition.substr(x + 3, y - x - 3), from, to);
  return nullptr;
}

}  // namespace

void RecordReader::read_other(const RecordJson& json, const Rule&,
                              std::shared_ptr<const Curve>& curve) const {
  curve = json.is_null() ? nullptr : curve_of(json.get<std::string>());
  if (!curve) require_absent(json);
}

void RecordReader::read_other(const RecordJson& json, const Rule& rule, std::string& text) const {
  if (rule.form == Form::kBytes) require_absent(json);
  text = json.is_null() ? "" : json.get<std::string>();
}

void RecordReader::read_other(const RecordJson& json, const Rule&, std::filesystem::path& file) const {
  if (json.is_null()) throw InputError("a file of the record was missing when the record was made");
  std::string path = find_({}, json.at("digest")).string();
  if (json.contains("layer")) path += ":" + json["layer"].get<std::string>();
  if (json.contains("project")) path += "@" + json["project"].get<std::string>();
  file = path;
}

void RecordReader::read_other(const RecordJson& json, const Rule&, Options& options) const {
  options = {};
  for (const auto& [group, keys] : json.items())
    for (const auto& [key, value] : keys.items()) {
      const std::string name = group + "." + key;
      if (value.is_null()) continue;
      OptionValue one = value.is_boolean()          ? OptionValue(value.get<bool>())
                        : value.is_number_integer() ? OptionValue(value.get<long long>())
                        : value.is_number()         ? OptionValue(value.get<double>())
                                                    : OptionValue(value.get<std::string>());
      options.set(name, std::move(one));
      if (options.value(name) == Options().value(name)) options.reset(name);
    }
}

void RecordReader::require_absent(const RecordJson& json) {
  if (!json.is_null())
    throw InputError(
        "the problem had functions or meshes in memory, which no record holds: it cannot be repeated");
}

double RecordReader::number(const RecordJson& json) {
  return json.is_string() ? numbers_in(json.get<std::string>()).at(0) : json.get<double>();
}

std::size_t RecordReader::word_in(const RecordJson& json, const Rule& rule) {
  const std::vector<std::string> words = words_of(rule.words);
  const auto text = json.get<std::string>();
  const auto at = std::ranges::find(words, text);
  if (at == words.end()) throw InputError("'" + text + "': expected " + rule.words);
  return static_cast<std::size_t>(at - words.begin());
}

}  // namespace delquad
