#include "mesher/repair_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<RepairOptions>& repair_table() {
  static const auto all =
      OptionTable<RepairOptions>("repair", "what happens beside the stages")
          .add({.name = "part_twins",
                .help = "of surfaces: whether edges and quads that two faces have in common are parted"},
               &RepairOptions::part_twins)
          .add({.name = "lift_bad_quads",
                .help = "of surfaces: whether quads that are bad in space are lifted there"},
               &RepairOptions::lift_bad_quads)
          .add({.name = "flat_corners",
                .help = "of curved elements: whether quads with flat corners get a ring of quads"},
               &RepairOptions::flat_corners)
          .add({.name = "across_cuts",
                .help =
                    "of surfaces: whether stages run once more with other cuts, where these were in the way"},
               &RepairOptions::across_cuts)
          .add({.name = "refine_unsound",
                .help = "whether sizes are made smaller where the mesh would not be sound"},
               &RepairOptions::refine_unsound)
          .add({.name = "keep_given", .help = "whether given quads stay where they would become worse"},
               &RepairOptions::keep_given);
  return all;
}

}  // namespace

OptionGroup repair_group() { return repair_table().group(); }
RepairOptions repair_options(const Options& options) { return repair_table().read(options); }

}  // namespace delquad
