#include "algorithms/insertion/insertion_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

/// Outside of its range the front never ends, or nothing can be inserted.
const OptionTable<InsertionOptions>& table() {
  static const auto all = OptionTable<InsertionOptions>("insertion", "options of F, D and P")
                              .add(
                                  {.name = "h_max",
                                   .help = "size of the triangles' circles that count as resolved",
                                   .least = 1.1,
                                   .most = 3,
                                   .absent = "the strategy's own"},
                                  [](auto& o) -> auto& { return o.frontal.h_max; })
                              .add(
                                  {.name = "rejection",
                                   .help = "least distance between points, in sizes",
                                   .above = 0,
                                   .most = 0.95},
                                  [](auto& o) -> auto& { return o.frontal.rejection; })
                              .add(
                                  {.name = "lower_clamp",
                                   .help = "whether D keeps points out of the circumsquare behind the edge"},
                                  [](auto& o) -> auto& { return o.linf.lower_clamp; });
  return all;
}

}  // namespace

OptionGroup insertion_group() { return table().group(); }
InsertionOptions insertion_options(const Options& options) { return table().read(options); }

}  // namespace delquad
