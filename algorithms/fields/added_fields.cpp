// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/added_fields.h"

#include <utility>

namespace delquad {

AddedParts<std::function<void(const Options&, SizeSpec&)>>& added_sizes() {
  static AddedParts<std::function<void(const Options&, SizeSpec&)>> all(
      "size", {"boundary", "x", "y", "z", "pi", "e"});
  return all;
}

AddedParts<std::function<void(const Options&, CrossSpec&)>>& added_crosses() {
  static AddedParts<std::function<void(const Options&, CrossSpec&)>> all(
      "cross field", {"boundary", "gradient", "size-aware", "metric", "x", "y", "pi", "e"});
  return all;
}

void add_size(const std::string& name, std::function<void(const Options&, SizeSpec&)> fill) {
  added_sizes().add(name, std::move(fill));
}

void add_cross(const std::string& name, std::function<void(const Options&, CrossSpec&)> fill) {
  added_crosses().add(name, std::move(fill));
}

}  // namespace delquad
