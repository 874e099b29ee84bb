// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "delquad/options.h"
#include "io/cases/toml_reader.h"

// This header lists the keys of models and cases. The program, the bench, readers and writers and the Python
// module use it.

namespace delquad {

/// Returns the keys of a model: the keys of a case without its name. Throws std::logic_error if added options
/// have the name of another key.
TomlKeys case_keys();
/// Returns the keys of criteria, and of the limits of a part.
TomlKeys criteria_keys();
TomlKeys named_criteria_keys();
/// Returns the options of a group.
TomlKeys keys_of(const OptionGroup& group);

/// Returns the JSON Schema of the value of a key, and of a table with these keys.
nlohmann::ordered_json schema_of(const TomlKey& key);
nlohmann::ordered_json schema_of(const TomlKeys& keys);

/// Types of values, as JSON Schema.
namespace toml_types {
inline const std::string kText = R"({"type": "string"})";
inline const std::string kFlag = R"({"type": "boolean"})";
inline const std::string kExpression = R"({"type": ["number", "string"]})";
inline const std::string kTexts = R"({"type": "array", "items": {"type": "string"}})";
inline const std::string kTextOrTexts = R"({"type": ["string", "array"], "items": {"type": "string"}})";
inline const std::string kWords = R"({"type": "object", "additionalProperties": {"type": "string"}})";
inline const std::string kRange =
    R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2})";
inline const std::string kSpacePoint =
    R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3})";
inline const std::string kVector =
    R"({"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3})";
/// Returns the JSON Schema of a list of `least` to `most` points.
std::string points(const std::string& point, double least, std::optional<double> most = {});
/// Returns the JSON Schema of one of these texts.
std::string one_of(const std::vector<std::string>& texts);
}  // namespace toml_types

/// Returns the options of all stages as a table in Markdown, with a newline at the end: name, allowed values,
/// default, meaning.
std::string option_table_text();

}  // namespace delquad
