#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/nearest_name.h"
#include "delquad/mesher.h"

namespace delquad {

const std::vector<Quality>& quality_registry() {
  static const std::vector<Quality> registry = {
      {"fast", "DB", CrossKind::kBoundary},
      {"good", "DBCO", CrossKind::kSizeAware},
      {"best", "DBCQO", CrossKind::kSizeAware},
  };
  return registry;
}

const Quality* find_quality(const std::string& name) {
  const auto at = std::ranges::find(quality_registry(), name, &Quality::name);
  return at == quality_registry().end() ? nullptr : &*at;
}

const Quality& quality_named(const std::string& name) {
  if (const Quality* quality = find_quality(name)) return *quality;
  std::vector<std::string> names;
  for (const Quality& q : quality_registry()) names.push_back(q.name);
  throw InputError(fmt::format("quality '{}': expected one of {}{}", name.substr(0, 40),
                               fmt::join(names, ", "), suggestion(name, names)));
}

}  // namespace delquad
