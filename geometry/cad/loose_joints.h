#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <array>
#include <vector>

#include "geometry/surface/surface_model.h"

namespace delquad::cad {

/// Two faces that meet at a place and share no nodes there.
struct LooseJoint {
  enum class Kind {
    kFaces,     ///< they lie on each other
    kEdge,      ///< an edge of the first lies on the second
    kCorner,    ///< an end of an edge of the first does
    kCrossing,  ///< one passes through the other
    kTouch      ///< they come together and part again
  };
  Kind kind;
  std::array<int, 2> faces;  ///< indices of regions
  Vec3 at;                   ///< a common place
};

/// The joints of faces that no shell of a solid has both, by their faces. Of two faces one is found, and of
/// parts (faces that hang together) none where they have another. A closed shell has none with itself, but
/// for faces that lie on each other up to their edges. `shells`: faces of each. Faces within `tolerance` (a
/// length) touch. `deflection`: how far triangles may be off; faces that lie on each other in less than a
/// triangle, or cross by less than that, may be missed.
std::vector<LooseJoint> loose_joints(const SurfaceModel& model, const std::vector<std::vector<int>>& shells,
                                     double deflection, double tolerance);

/// Two faces that come near to each other, do not touch, and share no nodes.
struct NearContact {
  std::array<int, 2> faces;  ///< indices of regions
  Vec3 at;                   ///< a place of the first
  double distance;           ///< from there to the second, a length
};

/// Of parts that are nowhere nearer than these distances to each other, up to `reach`, and have none of the
/// `joints` (all that touch): one for two parts, and one for two faces of an open part, of which one has a
/// free edge beside the other. Places are corners and middles of the triangulation's sides and triangles.
std::vector<NearContact> near_contacts(const SurfaceModel& model, const std::vector<std::vector<int>>& shells,
                                       const std::vector<LooseJoint>& joints, double deflection,
                                       double reach);

/// Where faces that do not hang together share a vertex, and for one of them it is no end of a curve: a
/// single point inside of it, or the pole of a sphere. No node of a mesh joins them there.
std::vector<LooseJoint> joints_at_points(const TopTools_IndexedMapOfShape& faces);

}  // namespace delquad::cad
