// SPDX-License-Identifier: GPL-3.0-or-later
// skew: the difference in length of a quad's diagonals, as a mean of powers over all quads.
#include <delquad/bench.h>
#include <delquad/extend.h>
#include <delquad/metrics.h>

#include <cmath>
#include <limits>

namespace {

using namespace delquad;

double mean_skew(const MetricInput& in) {
  const double power = in.options.number("skew.power");
  double sum = 0;
  for (const auto& v : in.mesh.quads) {
    const double one = norm(in.mesh.points[v[2]] - in.mesh.points[v[0]]);
    const double other = norm(in.mesh.points[v[3]] - in.mesh.points[v[1]]);
    sum += std::pow(std::abs(one - other) / (one + other), power);
  }
  const double n = static_cast<double>(in.mesh.quads.size());
  return n > 0 ? std::pow(sum / n, 1 / power) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

int main(int argc, char** argv) {
  add_options({.name = "skew",
               .help = "of the metric skew",
               .keys = {{.name = "power", .help = "of the mean", .value = 2.0, .least = 1, .most = 100}}});
  add_metric({.key = "skew",
              .title = "skew",
              .unit = "",
              .better = Better::kLower,
              .worst = 1,
              .source = "difference of a quad's diagonals over their sum",
              .digits = 4},
             mean_skew);
  return run_program(argc, argv);
}
