#include "algorithms/regularity/regularity.h"
#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<RegularityOptions>& table() {
  static const auto all =
      OptionTable<RegularityOptions>("regularity", "options of Q")
          .add({.name = "tolerance",
                .help = "what an irregular vertex less may cost: quads times eta",
                .least = 0,
                .most = 100},
               &RegularityOptions::tolerance)
          .add({.name = "quads", .help = "of a cavity, at most", .least = 1, .most = 2000},
               &RegularityOptions::quads)
          .add({.name = "rounds", .help = "over which the tolerance grows", .least = 1, .most = 1000},
               &RegularityOptions::rounds);
  return all;
}

}  // namespace

OptionGroup regularity_group() { return table().group(); }
RegularityOptions regularity_options(const Options& options) { return table().read(options); }

}  // namespace delquad
