// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "features/sizes/fine_spots.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header finds parts of a model by name. The pipeline and features use it.

namespace delquad {

/// The named parts of a model, as segments (points have length zero) and triangles. Nameless parts are called
/// by their number, as in files: curve_7, region_3.
class NamedParts {
 public:
  /// Lines, triangles and named points of a mesh.
  explicit NamedParts(const Mesh& mesh);
  /// Curves and points of a model, and the regions of a domain that was made from it.
  NamedParts(const PlanarModel& model, const PlanarDomain& domain);
  /// Lines and named points of a domain, and its regions.
  explicit NamedParts(const PlanarDomain& domain);

  /// Lines and points that are yet to be imprinted, straight.
  explicit NamedParts(const std::vector<LooseLine>& loose);

  /// Adds the lines of a mesh from this curve and this named point on.
  void add_lines(const Mesh& mesh, std::size_t first_curve = 0, std::size_t first_point = 0);
  /// Returns the sizes that are requested by names. Throws InputError for an unknown name.
  std::vector<LocalSize> spots(const std::vector<NamedSize>& wanted) const;
  /// Returns the spots without those names that nothing has.
  std::vector<LocalSize> known_spots(const std::vector<NamedSize>& wanted) const;

 private:
  struct Part {
    Vec3 a, b;
    std::optional<Vec3> c;
  };
  void add(const std::string& kind, const Entity& entity, const Part& part);
  void add_regions(const PlanarDomain& domain);

  std::map<std::string, std::vector<Part>> parts_;
};

}  // namespace delquad
