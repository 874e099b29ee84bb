#include "features/sizes/curve_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<CurveOptions>& curve_table() {
  static const auto all =
      OptionTable<CurveOptions>("curves", "edges on curves")
          .add({.name = "agreement",
                .help = "what an irregular vertex less is worth: quads times eta; 0: by the size alone",
                .least = 0,
                .most = 100},
               &CurveOptions::agreement)
          .add({.name = "join_below",
                .help = "in sizes: shorter curves become one with those that they continue; 0: none",
                .least = 0,
                .most = 100},
               &CurveOptions::join_below)
          .add({.name = "keep_named",
                .help = "faces and curves with names stay where --ignore-below would take them out"},
               &CurveOptions::keep_named);
  return all;
}

}  // namespace

OptionGroup curve_group() { return curve_table().group(); }
CurveOptions curve_options(const Options& options) { return curve_table().read(options); }

}  // namespace delquad
