// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/sweep/experiment_fields.h"
#include "io/cases/case_keys.h"
#include "io/cases/read_described.h"

namespace delquad {
namespace {

using namespace toml_types;
using Json = nlohmann::ordered_json;

const std::string kFolderName = R"({"type": "string", "pattern": "^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}$"})";
/// Keys of a model that do not vary.
const std::vector<std::string> kModels = {"name",    "loop", "pattern", "curve", "embed",
                                          "example", "mesh", "model",   "data",  "compare"};

Json list_of(const Json& items) { return {{"type", "array"}, {"minItems", 1}, {"items", items}}; }

/// The same keys, with lists of values in place of values.
Json matrix_schema(const TomlKeys& keys) {
  Json json = {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  for (const TomlKey& key : keys) {
    if (std::ranges::find(kModels, key.name) != kModels.end()) continue;
    Json choices = Json::array();
    choices.push_back(list_of(schema_of(key)));
    if (key.table != nullptr && !key.many) choices.push_back(matrix_schema(key.table()));
    json["properties"][key.name] = choices.size() == 1 ? choices[0] : Json{{"anyOf", choices}};
  }
  return json;
}

Json whole_matrix_schema() {
  Json json = matrix_schema(experiment_case_keys());
  json["patternProperties"] = {{"\\.", list_of(true)}};  // quoted keys with dots
  json["description"] = "keys of a case, each with a list of values: every combination is run";
  return json;
}

}  // namespace

TomlKeys experiment_case_keys() {
  TomlKeys keys = case_keys();
  keys.insert(keys.begin(), {"name", "name of the case and its folder", kFolderName, nullptr, false, true});
  std::ranges::move(keys_of<CaseOfStudy>(), std::back_inserter(keys));
  return keys;
}

TomlKeys variant_keys() {
  TomlKeys keys = {{"name", "in tables", kText, nullptr, false, true}};
  for (TomlKey& key : experiment_case_keys())
    if (std::ranges::find(kModels, key.name) == kModels.end()) keys.push_back(std::move(key));
  return keys;
}

TomlKeys experiment_keys() {
  TomlKeys keys = keys_of<TablePlan>();
  const auto add = [&](TomlKeys more, const char* but) {
    for (TomlKey& key : more)
      if (key.name != but) keys.push_back(std::move(key));
  };
  add(keys_of<ExperimentKeys>(), "");
  // A matrix has the keys of cases, see whole_matrix_schema().
  add({{"matrix", "what varies", R"({"type": "object"})"},
       {"variant", "keys of cases that vary together", "", variant_keys, true},
       {"case", "cases: models with their keys", "", experiment_case_keys, true},
       {"cases_of", "another experiment whose cases come before these", kText}},
      "");
  add(keys_of<CaseOfStudy>(), "domain");  // it belongs to one case
  add(case_keys(), "metric");             // here it is a measure
  return keys;
}

std::string experiment_schema() {
  Json json = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Delquad experiment"}};
  json.update(schema_of(experiment_keys()));
  json["properties"]["matrix"] = whole_matrix_schema();
  json["anyOf"] = {{{"required", {"case"}}}, {{"required", {"cases_of"}}}};
  return json.dump(2) + "\n";
}

}  // namespace delquad
