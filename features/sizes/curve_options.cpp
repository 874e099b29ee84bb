#include "features/sizes/curve_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

constexpr double kMostAlignment = 1e6;

const OptionTable<CurveOptions>& curve_table() {
  static const auto all =
      OptionTable<CurveOptions>("curves", "of surfaces: edges on curves, and size-aware crosses there")
          .add({.name = "agreement",
                .help = "what an irregular vertex less is worth: quads times eta; 0: by the size alone",
                .least = 0,
                .most = 100},
               &CurveOptions::agreement)
          .add({.name = "alignment",
                .help = "how much crosses are drawn to curves at which faces join smoothly; 0: not at all",
                .least = 0,
                .most = kMostAlignment},
               &CurveOptions::alignment)
          .add({.name = "cut_alignment",
                .help = "the same of cuts; with 1e6 crosses follow them, as if each patch had its own field",
                .least = 0,
                .most = kMostAlignment},
               &CurveOptions::cut_alignment)
          .add({.name = "join_below",
                .help = "in sizes: shorter curves become one with those that they continue; 0: none",
                .least = 0,
                .most = 100},
               &CurveOptions::join_below);
  return all;
}

}  // namespace

OptionGroup curve_group() { return curve_table().group(); }
CurveOptions curve_options(const Options& options) { return curve_table().read(options); }

}  // namespace delquad
