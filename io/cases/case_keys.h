#pragma once

#include <string>
#include <vector>

#include "delquad/options.h"
#include "io/cases/toml_keys.h"

namespace delquad {

/// The keys of a model, which are those of a case but for its name. Throws std::logic_error where options
/// from outside have the name of another key.
TomlKeys case_keys();
/// Of the tables inside.
const TomlKeys& curve_keys();
const TomlKeys& embed_keys();
const TomlKeys& loop_keys();
const TomlKeys& pattern_keys();
const TomlKeys& circle_keys();
const TomlKeys& arc_keys();
const TomlKeys& expression_keys();
const TomlKeys& surface_keys();
const TomlKeys& mirror_keys();
const TomlKeys& named_size_keys();
const TomlKeys& mapped_keys();
const TomlKeys& symmetry_keys();
const TomlKeys& periodic_keys();
const TomlKeys& division_keys();
const TomlKeys& size_keys();
const TomlKeys& source_keys();
const TomlKeys& layer_keys();
const TomlKeys& criteria_keys();
const TomlKeys& named_criteria_keys();
const TomlKeys& material_keys();
/// The options of a group.
TomlKeys keys_of(const OptionGroup& group);

/// Types of values, as JSON Schema.
namespace toml_types {
inline const std::string kText = R"({"type": "string"})";
inline const std::string kFlag = R"({"type": "boolean"})";
inline const std::string kNumber = R"({"type": "number"})";
inline const std::string kPositive = R"({"type": "number", "exclusiveMinimum": 0})";
inline const std::string kSize = R"({"type": ["number", "string"], "exclusiveMinimum": 0})";
inline const std::string kExpression = R"({"type": ["number", "string"]})";
inline const std::string kTexts = R"({"type": "array", "items": {"type": "string"}})";
/// A number, or integer, that is at least `least`.
std::string at_least(const std::string& type, double least);
std::string between(const std::string& type, double least, double most);
/// Above `low`.
std::string above(double low, double most);
std::string one_of(const std::vector<std::string>& texts);
}  // namespace toml_types

/// The options of all stages as a table in Markdown: name, what it may be, default, what it is. Ends with a
/// newline.
std::string option_table_text();

}  // namespace delquad
