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

const Quality& quality_named(const std::string& name) {
  const auto& all = quality_registry();
  const auto it = std::ranges::find(all, name, &Quality::name);
  if (it != all.end()) return *it;
  std::vector<std::string> names;
  for (const Quality& q : all) names.push_back(q.name);
  throw InputError(fmt::format("quality '{}': expected one of {}{}", name.substr(0, 40),
                               fmt::join(names, ", "), suggestion(name, names)));
}

}  // namespace delquad
