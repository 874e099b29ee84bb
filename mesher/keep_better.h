#pragma once

#include "mesher/finish_steps.h"

namespace delquad {

/// Where the mesh that the stages made of given quads is worse than these, see is_worse(), it becomes what
/// fewer of the stages make, if that is not, or else the given mesh. A warning says so. Returns whether it is
/// another.
bool keep_better(Finishing& on);

}  // namespace delquad
