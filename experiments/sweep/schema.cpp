#include "experiments/sweep/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/sweep/adapt_loop.h"
#include "experiments/sweep/peer.h"
#include "io/cases/case_keys.h"
#include "io/cases/read_described.h"

namespace delquad {
namespace {

using namespace toml_types;
using Json = nlohmann::ordered_json;

const std::string kCommand = R"({"type": "array", "items": {"type": "string"}, "minItems": 1})";
const std::string kExitCodes =
    R"({"type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 255}, "minItems": 1})";
const std::string kPoints =
    R"({"type": "array", "items": {"type": "integer", "minimum": 3, "maximum": 10000000}, "minItems": 1})";
const std::string kSeeds =
    R"({"type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 1000000000}, "minItems": 1})";
const std::string kColumnList =
    R"({"type": "array", "items": {"type": "string"}, "minItems": 1, "uniqueItems": true})";
const std::string kFolderName = R"({"type": "string", "pattern": "^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}$"})";
const std::string kPeerName = R"({"type": "string", "pattern": "^[a-z][A-Za-z0-9_.-]{0,99}$"})";
const std::string kMetricName = R"({"type": "string", "pattern": "^[A-Za-z][A-Za-z0-9_-]{0,59}$"})";
const std::string kSolvers =
    R"({"type": "array", "items": {"enum": ["poisson", "elasticity"]}, "uniqueItems": true})";
const std::string kCalibrate = one_of({"quads", "none"});
/// What a model is made of, which does not vary.
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

TomlKeys peer_keys() {
  return {{"name", "in pipelines and tables", kPeerName, nullptr, false, true},
          {"command", "program and arguments, with {input} and {output}", kCommand, nullptr, false, true},
          {"version", "program and arguments that print the version", kCommand, nullptr, false, true},
          {"input", "what it reads", one_of({"geo", "msh", "obj", "inp", "mesh"})},
          {"output", "what it writes", one_of({"msh", "obj", "off", "stl"})},
          {"exit_codes", "with which its mesh is worth a look", kExitCodes},
          {"keeps_boundary", "whether it has the boundary's edges", kFlag},
          {"planar", "what it gets of planar domains", one_of({"boundary", "triangles", "none"})},
          {"surfaces", "what it gets of surfaces", one_of({"file", "triangles", "none"})},
          {"size_field", "format of the file that {size_field} stands for", one_of(size_field_formats())},
          {"metrics", "whether it knows metrics, and finds their tensors in that file", kFlag},
          {"calibrate", "whether its size is changed until it has our number of quads", kCalibrate},
          {"calibrate_to", "the word whose number that is", kText}};
}

TomlKeys peer_file_keys() { return {{"peer", "other meshers", "", peer_keys, true, true}}; }

TomlKeys metric_keys() {
  return {{"name", "in tables and records", kMetricName, nullptr, false, true},
          {"command", "program and arguments, with {mesh}", kCommand, nullptr, false, true},
          {"files", "that its value depends on, too", kTexts},
          {"title", "in tables; else the name", kText},
          {"unit", "for people", kText},
          {"better", "which values are", one_of({"higher", "lower", "neither"})},
          {"digits", "after the decimal point, in tables", between("integer", 0, kMostDigits)},
          {"timeout", "seconds that it may take", between("integer", 1, kMostSeconds)}};
}

TomlKeys hypothesis_keys() {
  return {{"better", "what is expected to be better: a pipeline, or a value of 'along'", kExpression, nullptr,
           false, true},
          {"than", "what it is expected to be better than", kExpression, nullptr, false, true},
          {"along", "what varies, by its title; else pipelines are compared", kText},
          {"measures", "keys of measures, each of them a test", kColumnList, nullptr, false, true}};
}

TomlKeys may_fail_keys() {
  return {{"case", "its name; else any", kText},
          {"variant", "its name; else any", kText},
          {"pipeline", "one of those that are run; else any", kText}};
}

TomlKeys linf_study_keys() {
  return {{"points", "how many", kPoints, nullptr, false, true},
          {"seeds", "of the points", kSeeds, nullptr, false, true}};
}

TomlKeys experiment_case_keys() {
  TomlKeys keys = case_keys();
  keys.insert(keys.begin(), {"name", "of its folder", kFolderName, nullptr, false, true});
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
  TomlKeys keys = {{"title", "of the tables", kText},
                   {"pipelines", "words of stages and names of peers", kTexts},
                   {"peer", "other meshers", "", peer_keys, true},
                   {"peer_files", "files with further peers", kTexts},
                   {"calibrate", "whether peers are compared at our number of quads", kCalibrate},
                   {"calibrate_to", "the word whose number that is", kText},
                   {"metric", "measures that other programs take", "", metric_keys, true},
                   {"solver", "finite elements that measure every mesh", kSolvers},
                   {"pairs", "what varies, by titles: compared as pipelines are", kColumnList},
                   {"hypotheses", "claims that are fixed before the run", "", hypothesis_keys, true},
                   {"may_fail", "cells that may fail", "", may_fail_keys, true},
                   {"minutes", "of a run on two cores, as measured: for the time left", kPositive},
                   {"reference", "a file of published rows", kText},
                   {"step_times", "whether tables have a column for each step's time", kFlag},
                   {"columns", "of tables in Markdown and LaTeX, by key", kColumnList},
                   {"linf_delaunay", "in place of cases: point sets", "", linf_study_keys},
                   // Its keys are those of cases, see whole_matrix_schema().
                   {"matrix", "what varies", R"({"type": "object"})"},
                   {"variant", "keys of cases that vary together", "", variant_keys, true},
                   {"case", "what is meshed", "", experiment_case_keys, true},
                   {"cases_of", "another experiment whose cases come before these", kText}};
  for (TomlKey& key : keys_of<CaseOfStudy>())  // a domain belongs to one case
    if (key.name != "domain") keys.push_back(std::move(key));
  for (TomlKey& key : case_keys())  // here 'metric' is a measure
    if (key.name != "metric") keys.push_back(std::move(key));
  return keys;
}

std::string experiment_schema() {
  Json json = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Delquad experiment"}};
  json.update(schema_of(experiment_keys()));
  json["properties"]["matrix"] = whole_matrix_schema();
  json["anyOf"] = {{{"required", {"case"}}}, {{"required", {"cases_of"}}}, {{"required", {"linf_delaunay"}}}};
  return json.dump(2) + "\n";
}

}  // namespace delquad
