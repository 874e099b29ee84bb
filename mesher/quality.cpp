#include <algorithm>

#include "delquad/mesher.h"

namespace delquad {

const std::vector<Quality>& quality_registry() {
  static const std::vector<Quality> registry = {
      {"fast", "DB", CrossKind::kBoundary},
      {"good", "DBCO", CrossKind::kSizeAware},
      {"best", "DLBCO", CrossKind::kSizeAware},
  };
  return registry;
}

const Quality& quality_named(const std::string& name) {
  const auto& all = quality_registry();
  const auto it = std::ranges::find(all, name, &Quality::name);
  if (it != all.end()) return *it;
  std::string known;
  for (const Quality& q : all) known += (known.empty() ? "" : ", ") + q.name;
  throw InputError("quality '" + name.substr(0, 40) + "': expected one of " + known);
}

}  // namespace delquad
