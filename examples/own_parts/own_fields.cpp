// SPDX-License-Identifier: GPL-3.0-or-later
// winding: crosses that wind about the middle of each patch. bump: sizes that are small near the origin.
#include <delquad/bench.h>
#include <delquad/extend.h>

#include <cmath>
#include <memory>

namespace {

using namespace delquad;

class Winding final : public CrossField {
 public:
  Winding(Vec2 middle, double turn) : middle_(middle), turn_(turn) {}
  Cross at(Vec2 u, int&) const override {
    const Vec2 d = u - middle_;
    return Cross::from_angle((norm(d) > 0 ? std::atan2(d.y, d.x) : 0) + turn_);
  }

 private:
  Vec2 middle_;
  double turn_;
};

}  // namespace

int main(int argc, char** argv) {
  add_options({.name = "winding",
               .help = "of the crosses winding",
               .keys = {{.name = "turn", .help = "radians", .value = 0.0, .least = -1, .most = 1}}});
  add_cross("winding", [](const Options&, CrossSpec& cross) {
    cross.kind = CrossKind::kMade;
    cross.maker = [](const PatchBoundary& boundary, const ParametricSize&, const Options& options) {
      Vec2 sum{};
      for (const Vec2 p : boundary.points) sum += p;
      const Vec2 middle = (1.0 / static_cast<double>(boundary.points.size())) * sum;
      return std::make_shared<Winding>(middle, options.number("winding.turn"));
    };
  });
  add_size("bump", [](const Options&, SizeSpec& size) {
    size.field = make_function_size([](const Vec3& x) { return 0.05 + 0.1 * norm(x); }, "bump");
  });
  return run_program(argc, argv);
}
