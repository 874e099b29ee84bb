#include "geometry/mesh/entity_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace delquad {

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

}  // namespace delquad
