// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/sizes/curve_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<CurveOptions>& curve_table() {
  static const auto all =
      OptionTable<CurveOptions>("curves", "edges on curves")
          .add({.name = "agreement",
                .help = "price of an irregular vertex, in quads times eta; 0: numbers follow the size alone",
                .least = 0,
                .most = 100},
               &CurveOptions::agreement)
          .add({.name = "round_holes",
                .help = "more edges around small round holes, where that leaves fewer irregular vertices "
                        "beside them"},
               &CurveOptions::round_holes)
          .choice({.name = "thin",
                   .help = "thin regions and narrow faces: smaller sizes where they end, or whole rows of "
                           "long quads"},
                  &CurveOptions::thin_rows,
                  std::vector<std::pair<std::string, bool>>{{"refine", false}, {"rows", true}})
          .add({.name = "aspect",
                .help = "in the plane: aspect of quads at the ends of such rows, above which sizes shrink",
                .least = 1,
                .most = 100},
               &CurveOptions::aspect)
          .add({.name = "gap_rows",
                .help = "rows of quads that fit between curves of a region or face; 0: by the size alone",
                .least = 0,
                .most = 1000},
               &CurveOptions::gap_rows)
          .add({.name = "keep_named",
                .help = "faces and curves with names stay where --ignore-below would take them out"},
               &CurveOptions::keep_named);
  return all;
}

}  // namespace

OptionGroup curve_group() { return curve_table().group(); }
CurveOptions curve_options(const Options& options) { return curve_table().read(options); }

}  // namespace delquad
