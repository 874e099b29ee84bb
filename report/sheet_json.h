#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "delquad/mesh.h"

namespace delquad {

using Json = nlohmann::ordered_json;

/// What a page says of one cell: from its record, and from its mesh where there is one.
Json cell_json(const Json& record, const std::optional<Mesh>& mesh);

/// What holds for a variant of a case, by the record of one of its cells: pairs of texts.
Json facts_json(const Json& record);

}  // namespace delquad
