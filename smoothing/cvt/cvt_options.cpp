#include "smoothing/cvt/cvt_options.h"

#include "base/option_table.h"

namespace delquad {
namespace {

constexpr double kMostRounds = 1e6;

const OptionTable<CvtOptions>& table() {
  static const auto all =
      OptionTable<CvtOptions>("smoothing", "options of L")
          .choice({.name = "method", .help = "what makes the energy smaller"}, &CvtOptions::method,
                  std::vector<std::pair<std::string, SmoothingMethod>>{{"lpcvt", SmoothingMethod::kLpCvt},
                                                                       {"lloyd", SmoothingMethod::kLloyd}})
          .add(
              {.name = "p", .help = "norm", .allowed = {2, 4, 6, 8, 10, 12, 14, 16}},
              [](auto& o) -> auto& { return o.smoothing.p; })
          .add(
              {.name = "outer_iterations",
               .help = "how often size and directions are taken anew",
               .least = 0,
               .most = kMostRounds},
              [](auto& o) -> auto& { return o.smoothing.outer_iterations; })
          .add(
              {.name = "inner_iterations", .help = "steps for each", .least = 0, .most = kMostRounds},
              [](auto& o) -> auto& { return o.smoothing.inner.iterations; })
          .add(
              {.name = "function_tolerance", .help = "relative", .least = 0},
              [](auto& o) -> auto& { return o.smoothing.inner.function_tolerance; });
  return all;
}

}  // namespace

OptionGroup smoothing_group() { return table().group(); }
CvtOptions cvt_options(const Options& options) { return table().read(options); }

}  // namespace delquad
