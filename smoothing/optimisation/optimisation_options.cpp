#include "smoothing/optimisation/optimisation_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<OptimisationOptions>& table() {
  static const auto all =
      OptionTable<OptimisationOptions>("optimisation", "options of O")
          .add({.name = "passes", .help = "how often, at most", .least = 0, .most = 1000},
               &OptimisationOptions::passes)
          .add({.name = "iterations", .help = "of L-BFGS in each", .least = 1, .most = 1e5},
               &OptimisationOptions::iterations)
          .add({.name = "size", .help = "weight of the edges' lengths", .least = 0},
               &OptimisationOptions::size)
          .add({.name = "alignment", .help = "weight of the edges' directions", .least = 0},
               &OptimisationOptions::alignment);
  return all;
}

}  // namespace

OptionGroup optimisation_group() { return table().group(); }
OptimisationOptions optimisation_options(const Options& options) { return table().read(options); }

}  // namespace delquad
