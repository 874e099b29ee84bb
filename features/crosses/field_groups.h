#pragma once

#include <memory>
#include <vector>

#include "fields/size_aware_cross_field.h"
#include "patches/prepared.h"

namespace delquad {

/// Patches that hang together by seams, so that their fields are one.
struct FieldGroup {
  std::vector<int> patches;      ///< indices into PreparedProblem::patches, ascending
  std::vector<FieldSeam> seams;  ///< with indices into `patches`
};

/// All patches, in groups. Seams are the edges of a surface's cuts, and of curves at which two faces join
/// smoothly: features, the outline and curves of planar domains are none. `backgrounds`: of each patch, made
/// from its boundary, whose edges are all there.
std::vector<FieldGroup> field_groups(const PreparedProblem& prepared,
                                     const std::vector<std::shared_ptr<const BackgroundMesh>>& backgrounds);

}  // namespace delquad
