#include "algorithms/cleanup/cleanup.h"
#include "base/option_table.h"

namespace delquad {
namespace {

const OptionTable<CleanupOptions>& table() {
  static const auto all =
      OptionTable<CleanupOptions>("cleanup", "options of C")
          .add({.name = "rounds", .help = "of annealing; 0: greedy only", .least = 0, .most = 1e6},
               &CleanupOptions::rounds)
          .add({.name = "tolerance",
                .help = "what an edit may cost in the first round",
                .above = 0,
                .most = 1},
               &CleanupOptions::tolerance)
          .add({.name = "seed", .help = "of the annealing", .least = 0}, &CleanupOptions::seed);
  return all;
}

}  // namespace

OptionGroup cleanup_group() { return table().group(); }
CleanupOptions cleanup_options(const Options& options) { return table().read(options); }

}  // namespace delquad
