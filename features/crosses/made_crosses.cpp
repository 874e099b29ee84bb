// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/crosses/made_crosses.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "base/located.h"
#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// A field by a maker from outside. It refuses values that are no crosses.
class Checked final : public CrossField {
 public:
  Checked(std::shared_ptr<const CrossField> made, std::string where)
      : made_(std::move(made)), where_(std::move(where)) {}
  Cross at(Vec2 u, int& hint) const override {
    const Cross cross = made_->at(u, hint);
    if (!std::isfinite(cross.c) || !std::isfinite(cross.s))
      throw InputError(fmt::format("{}: {} at {}: expected cosine and sine of four times an angle", where_,
                                   show_point(Vec2{cross.c, cross.s}), show_point(u)));
    return cross;
  }

 private:
  std::shared_ptr<const CrossField> made_;
  std::string where_;
};

}  // namespace

void use_made_crosses(const CrossSpec& spec, MeshingSetup& prepared) {
  prepared.crosses = {};
  parallel_for(prepared.patches.size(), [&](std::size_t i) {
    const FaceScope face = patch_scope(prepared, i);
    PatchSetup& patch = prepared.patches[i];
    patch.cross = located(spec.where,
                          [&] { return spec.maker(patch.boundary, *patch.size, prepared.settings.options); });
    if (!patch.cross) throw InputError(spec.where + ": the maker of the cross field returned none");
    patch.cross = std::make_shared<Checked>(patch.cross, spec.where);
  });
}

}  // namespace delquad
