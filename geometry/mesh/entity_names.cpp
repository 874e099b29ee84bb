// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/entity_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/nearest_name.h"
#include "delquad/error.h"

namespace delquad {

std::vector<std::string> KeptNames::of(const Entity& entity) const {
  std::vector<std::string> kept = entity.names;
  if (!all)
    std::erase_if(kept,
                  [&](const std::string& name) { return std::ranges::find(names, name) == names.end(); });
  return kept;
}

std::string region_label(const Entity& region) {
  return region.names.empty() ? fmt::format("region_{}", region.tag) : region.names[0];
}

bool has_name(const Entity& region, const std::string& name) {
  return name == fmt::format("region_{}", region.tag) ||
         std::ranges::find(region.names, name) != region.names.end();
}

std::string curve_title(const Entity& curve) {
  return curve.names.empty() ? fmt::format("curve {}", curve.tag) : "'" + curve.names[0] + "'";
}

std::vector<int> entities_named(const std::vector<Entity>& entities, const std::string& kind,
                                const std::string& name) {
  std::vector<int> found;
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (name == fmt::format("{}_{}", kind, entities[i].tag) ||
        std::ranges::find(entities[i].names, name) != entities[i].names.end())
      found.push_back(static_cast<int>(i));
  return found;
}

std::vector<int> find_entities(const std::vector<Entity>& entities, const std::string& kind,
                               const std::string& name, const std::string& where) {
  std::vector<int> found = entities_named(entities, kind, name);
  if (!found.empty()) return found;
  std::vector<std::string> known;
  for (const Entity& e : entities) known.insert(known.end(), e.names.begin(), e.names.end());
  throw InputError(fmt::format("{}: no {} is called '{}'{} [unknown-name]", where, kind, name,
                               suggestion_or_all(name, known)));
}

}  // namespace delquad
