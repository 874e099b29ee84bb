#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/matching/side_counts.h"
#include "delquad/model.h"

namespace delquad {

/// A part of a face's outline between two nodes that any mesh has, the face on its left.
struct OutlinePart {
  int curve;     ///< a piece of one, whose number of edges is to be chosen
  int node;      ///< at which it begins
  Vec3 at;       ///< that node
  double angle;  ///< inside of the face, there; radians
  double want;   ///< edges
};
using FaceOutline = std::vector<std::vector<OutlinePart>>;  ///< loops, the outer one first

/// A face that is to become a grid of four sides, three grids around a middle of three, or a ring.
struct MappedFace {
  int face;
  bool is_asked;  ///< by name, and not found
  std::vector<std::vector<int>>
      sides;                        ///< four or three, of curves, one after the other; of a ring its loops
  std::vector<std::size_t> begins;  ///< where in the outline they begin, ascending; of a ring: none
};

/// Tells which faces become grids, and where these have their corners: at the points that are told; else a
/// face with just three nodes that turn by more than 30 degrees, or three at all, has these, any other the
/// four nodes at which it turns most as a rectangle does. Two loops that turn nowhere are a ring. What is
/// asked for by `automatic` has four corners within 35 degrees of right angles, all else within 30 degrees of
/// straight, and opposite sides that want numbers of edges within a factor of two.
class GridFinder {
 public:
  using NamedPlaces = std::vector<std::pair<std::string, Vec3>>;
  /// Throws InputError for names that no region has. The arguments outlive this object.
  GridFinder(const MappedSpec& spec, const std::vector<Entity>& regions, const NamedPlaces& points);

  /// Nothing where the face stays free. Throws InputError where a named one cannot be a grid.
  std::optional<MappedFace> find(int face, const Entity& region, const FaceOutline& outline);
  /// Throws InputError for corners that lie on no outline.
  void finish() const;

 private:
  struct Corners {
    const GridCorners* asked;
    std::vector<Vec3> at;
    bool is_used = false;
    std::string missing;  ///< why they are no nodes of an outline
  };
  std::vector<std::size_t> told_corners(const Entity& region, const FaceOutline& outline);

  const MappedSpec& spec_;
  std::vector<Corners> corners_;
};

/// Chooses numbers of edges, see balance_counts(). `around`: of each face its curves, each as often as it
/// lies beside; `leader`: of each curve the one whose number it has. Faces that are not asked for become free
/// where the others cannot agree with them.
std::vector<UnbalancedFace> balance_grids(std::vector<CountedCurve>& curves,
                                          const std::vector<std::vector<int>>& around,
                                          const std::vector<int>& leader, std::vector<MappedFace>& mapped);

/// Why it cannot be balanced. `mapped`: null of a free face. `curves`: with the numbers of edges that they
/// have, `names` what they are called.
std::string why_unbalanced(const UnbalancedFace& bad, const std::string& label, const MappedFace* mapped,
                           const std::vector<CountedCurve>& curves, const std::vector<std::string>& names);

}  // namespace delquad
