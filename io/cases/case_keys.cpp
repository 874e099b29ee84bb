// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "delquad/mesher.h"
#include "io/cases/read_described.h"
#include "io/cases/shapes.h"

namespace delquad {

namespace toml_types {

std::string points(const std::string& point, double least, std::optional<double> most) {
  return fmt::format(R"({{"type": "array", "items": {}, "minItems": {}{}}})", point, least,
                     most ? fmt::format(R"(, "maxItems": {})", *most) : "");
}

std::string one_of(const std::vector<std::string>& texts) {
  return fmt::format(R"({{"enum": ["{}"]}})", fmt::join(texts, R"(", ")"));
}

}  // namespace toml_types

namespace {

using namespace toml_types;

/// The type of an option's value, as JSON Schema.
std::string type_of(const OptionKey& key) {
  if (const std::vector<OptionValue> allowed = allowed_values(key); !allowed.empty()) {
    std::vector<std::string> texts;
    for (const OptionValue& value : allowed) texts.push_back(text_of(value));
    return fmt::format(R"({{"enum": [{}]}})", fmt::join(texts, ", "));
  }
  const char* types[] = {R"("boolean")", R"("integer")", R"("number")", R"("string")"};
  return limited_type(types[key.value.index()], {.least = key.least, .above = key.above, .most = key.most});
}

/// Returns the keys, followed by the limits.
TomlKeys with_criteria(TomlKeys keys) {
  for (const Criterion& criterion : criterion_registry())
    keys.push_back({criterion.key, "limit, by " + criterion.source, kExpression});
  return keys;
}

}  // namespace

TomlKeys named_criteria_keys() {
  return with_criteria({{"name", "name of curves or regions", kText, nullptr, false, true}});
}

TomlKeys criteria_keys() {
  TomlKeys keys = with_criteria(
      {{"name", "name in reports", kText},
       {"preset", "limits to begin with: batch, crash or static", one_of({"batch", "crash", "static"})},
       {"on", "limits of parts by name, in place of the others", "", named_criteria_keys, true}});
  std::ranges::move(keys_of<Criteria>(), std::back_inserter(keys));
  return keys;
}

TomlKeys keys_of(const OptionGroup& group) {
  TomlKeys keys;
  for (const OptionKey& key : group.keys) keys.push_back({key.name, key.help, type_of(key)});
  return keys;
}

TomlKeys case_keys() {
  TomlKeys keys = {{"loop", "closed loops", "", keys_of<LoopShape>, true},
                   {"pattern", "a loop repeated on a grid", "", keys_of<PatternShape>, true},
                   {"curve", "curves that loops are made of", "", keys_of<NamedShape>, true},
                   {"embed",
                    "curves and points inside of regions, polylines and points on surfaces; at the top of an "
                    "experiment on surfaces alone",
                    "", keys_of<EmbeddedShape>, true},
                   {"example", "a surface that the program makes itself", kText},
                   {"mesh", "an MSH file; with 'start' of any format", kText},
                   {"start", "pipelines may begin from the elements of that mesh", kFlag},
                   {"model", "a model file, a surface or an MSH file", kText},
                   {"data", "a surface or MSH file in the folder of --data", kText}};
  for (TomlKey& key : keys_of<MeshProblem>()) {
    const auto holds = [&](TomlKeys (*table)(), bool many) {
      key.table = table;
      key.many = many;
    };
    if (key.name == "size") holds(keys_of<SizeSpec>, false);
    if (key.name == "symmetry") holds(keys_of<SymmetryPlane>, true);
    if (key.name == "mapped") holds(keys_of<GridCorners>, true);
    if (key.name == "criteria") holds(criteria_keys, false);
    keys.push_back(std::move(key));
  }
  for (const OptionGroup& group : option_groups()) {
    if (std::ranges::find(keys, group.name, &TomlKey::name) != keys.end())
      throw std::logic_error("options '" + group.name + "': a key of cases has that name");
    keys.push_back({group.name, group.help, "", [group] { return keys_of(group); }});
  }
  return keys;
}

nlohmann::ordered_json schema_of(const TomlKey& key) {
  nlohmann::ordered_json choices = nlohmann::ordered_json::array();
  if (!key.type.empty()) choices.push_back(nlohmann::ordered_json::parse(key.type));
  if (key.table != nullptr) {
    choices.push_back(schema_of(key.table()));
    if (key.many) choices.push_back({{"type", "array"}, {"items", choices.back()}});
  }
  return choices.size() == 1 ? choices[0] : nlohmann::ordered_json{{"anyOf", choices}};
}

nlohmann::ordered_json schema_of(const TomlKeys& keys) {
  nlohmann::ordered_json json = {
      {"type", "object"}, {"additionalProperties", false}, {"properties", nlohmann::ordered_json::object()}};
  nlohmann::ordered_json required = nlohmann::ordered_json::array();
  for (const TomlKey& key : keys) {
    nlohmann::ordered_json& property = json["properties"][key.name] = {{"description", key.about}};
    property.update(schema_of(key));
    if (key.required) required.push_back(key.name);
  }
  if (!required.empty()) json["required"] = required;
  return json;
}

std::string option_table_text() {
  std::string text = "| option | value | default | |\n|---|---|---|---|\n";
  for (const OptionGroup& group : option_groups())
    for (const OptionKey& key : group.keys)
      text += fmt::format("| `{}.{}` | {} | {} | {} |\n", group.name, key.name, expected_of(key),
                          key.absent.empty() ? text_of(key.value) : key.absent, key.help);
  return text;
}

}  // namespace delquad
