#include "pipeline/quality.h"

#include <algorithm>

#include "mesh/error.h"

namespace delquad {

std::span<const Quality> quality_registry() {
  static const Quality registry[] = {
      {"fast", "DB", "boundary"},
      {"good", "DBCO", "size-aware"},
      {"best", "DLBCO", "size-aware"},
  };
  return registry;
}

const Quality& quality_named(const std::string& name) {
  const auto all = quality_registry();
  const auto it = std::ranges::find(all, name, &Quality::name);
  if (it != all.end()) return *it;
  std::string known;
  for (const Quality& q : all) known += (known.empty() ? "" : ", ") + q.name;
  throw InputError("quality '" + name.substr(0, 40) + "': expected one of " + known);
}

}  // namespace delquad
