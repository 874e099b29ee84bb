// SPDX-License-Identifier: GPL-3.0-or-later
// aligned: merges triangles if the quad's sides run along the cross, regardless of its angles.
#include <delquad/bench.h>
#include <delquad/extend.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace delquad;

/// From 0, along the cross, to 1, at 45 degrees to it.
double astray(Vec2 side, Cross cross) {
  const Cross own = Cross::along(side);
  const double cosine = (own.c * cross.c + own.s * cross.s) / std::hypot(cross.c, cross.s);
  return (1 - std::clamp(cosine, -1.0, 1.0)) / 2;
}

}  // namespace

int main(int argc, char** argv) {
  add_options({.name = "aligned",
               .help = "of the cost aligned",
               .keys = {{.name = "weight", .help = "beside 1 - eta", .value = 1.0, .least = 0, .most = 2}}});
  add_merge_cost("aligned", [](const Options& options) {
    const double weight = options.number("aligned.weight");
    return [weight](std::span<const MergedQuad> quads, std::span<double> cost) {
      for (std::size_t i = 0; i < quads.size(); ++i) {
        const auto& [a, b, c, d] = quads[i].corners;
        double most = 0;
        for (const Vec2 side : {b - a, c - b, d - c, a - d})
          most = std::max(most, astray(side, quads[i].cross));
        cost[i] = 1 - quad_eta(a, b, c, d) + weight * most;
      }
    };
  });
  return run_program(argc, argv);
}
