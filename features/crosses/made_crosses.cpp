#include "features/crosses/made_crosses.h"

#include <cstddef>

#include "base/located.h"
#include "base/parallel.h"
#include "delquad/error.h"

namespace delquad {

void use_made_crosses(const CrossSpec& spec, PreparedProblem& prepared) {
  prepared.crosses = {};
  parallel_for(prepared.patches.size(), [&](std::size_t i) {
    const DoingFace face = doing_patch(prepared, i);
    PreparedPatch& patch = prepared.patches[i];
    patch.cross = located(spec.where,
                          [&] { return spec.maker(patch.boundary, *patch.size, prepared.settings.options); });
    if (!patch.cross) throw Error(spec.where + ": the cross field's maker made none");
  });
}

}  // namespace delquad
