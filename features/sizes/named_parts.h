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

/// The named parts of a model, as segments (points have length zero) and triangles. Nameless parts have their
/// number as name, as in files: curve_7, region_3.
class NamedParts {
 public:
  /// Takes lines, triangles and named points of a mesh.
  explicit NamedParts(const Mesh& mesh);
  /// Takes curves and points of a model, and the regions of its domain.
  NamedParts(const PlanarModel& model, const PlanarDomain& domain);
  /// Takes lines, named points and regions of a domain.
  explicit NamedParts(const PlanarDomain& domain);

  /// Takes straight lines and points before they are imprinted.
  explicit NamedParts(const std::vector<LooseLine>& loose);

  /// Adds lines and named points of a mesh, from these indices of curves and points on.
  void add_lines(const Mesh& mesh, std::size_t first_curve = 0, std::size_t first_point = 0);
  /// Returns the sizes that are requested by names. Throws InputError, with similar names, for an unknown
  /// name.
  std::vector<LocalSize> spots(const std::vector<NamedSize>& wanted) const;
  /// Does the same and leaves out unknown names.
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
