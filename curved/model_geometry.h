#pragma once

#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// The true model behind a mesh: where nodes of curved elements go. Safe to call from several threads.
class ModelGeometry {
 public:
  virtual ~ModelGeometry() = default;
  /// Points of the curve of a line (index into Mesh::lines) at these parts of the way, by length along the
  /// curve, from its first end to its second; parts strictly between 0 and 1, ascending.
  virtual std::vector<Vec3> on_line(int line, std::span<const double> parts) const = 0;
  /// The point of a face (index into Mesh::regions) nearest to x.
  virtual Vec3 on_face(int region, const Vec3& x) const = 0;
};

}  // namespace delquad
