// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header finds and keeps names of parts. Features use it.

namespace delquad {

/// Names that must stay.
struct KeptNames {
  bool all = false;  ///< whether all names stay
  std::vector<std::string> names = {};

  /// Returns the names of an entity that must stay.
  std::vector<std::string> of(const Entity& entity) const;
  bool any_of(const Entity& entity) const { return !of(entity).empty(); }
};

/// Returns the title of a region in messages.
std::string region_label(const Entity& region);

/// Returns whether a region has the name, or the number as in files: "region_2".
bool has_name(const Entity& region, const std::string& name);

/// Returns the title of a curve in messages: its first name, or its number.
std::string curve_title(const Entity& curve);

/// Returns the indices of entities with the name, or with the number as in files. `kind` is "curve" or
/// "region".
std::vector<int> entities_named(const std::vector<Entity>& entities, const std::string& kind,
                                const std::string& name);

/// Returns the same. Throws InputError, beginning with `where`, if no entity has the name.
std::vector<int> find_entities(const std::vector<Entity>& entities, const std::string& kind,
                               const std::string& name, const std::string& where);

}  // namespace delquad
