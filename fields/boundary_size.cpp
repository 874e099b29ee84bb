#include <cmath>
#include <utility>

#include "fields/check_size.h"
#include "fields/fields.h"
#include "fields/laplace.h"

namespace delquad {

namespace {

/// log delta, linear on the background's triangles.
class BoundarySize final : public SizeField {
 public:
  BoundarySize(std::shared_ptr<const BackgroundMesh> background, std::vector<double> log_delta)
      : background_(std::move(background)), log_delta_(std::move(log_delta)) {}

  double at(const Vec3& x, int& hint) const override {
    const auto [t, b] = background_->locate({x.x, x.y}, hint);
    const auto& v = background_->triangles().triangles[t];
    return std::exp(b[0] * log_delta_[v[0]] + b[1] * log_delta_[v[1]] + b[2] * log_delta_[v[2]]);
  }

 private:
  std::shared_ptr<const BackgroundMesh> background_;
  std::vector<double> log_delta_;
};

/// Mean length of the lines at each point; NaN where there are none.
std::vector<double> mean_lengths(const Mesh& boundary) {
  std::vector<double> sum(boundary.points.size(), 0);
  std::vector<int> count(boundary.points.size(), 0);
  for (const auto& [a, b] : boundary.lines) {
    const double length = norm(boundary.points[b] - boundary.points[a]);
    for (const int v : {a, b}) {
      sum[v] += length;
      ++count[v];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  return sum;
}

}  // namespace

std::unique_ptr<SizeField> make_boundary_size(std::shared_ptr<const BackgroundMesh> background,
                                              const Mesh& boundary) {
  const std::vector<double> length = mean_lengths(boundary);
  const auto& points = background->boundary_points();
  std::vector<char> fixed(points.size(), 0);
  std::vector<double> columns[] = {std::vector<double>(points.size(), 0)};
  std::vector<double>& log_delta = columns[0];
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto& p = points[v];
    if (p.from < 0) continue;
    for (const int node : {p.from, p.to}) {
      if (!is_size(length[node]))
        throw bad_size("the boundary's edge length", boundary.points[node], length[node]);
    }
    fixed[v] = 1;
    log_delta[v] = (1 - p.t) * std::log(length[p.from]) + p.t * std::log(length[p.to]);
  }
  solve_laplace(background->triangles(), background->triangles().triangles, fixed, columns);
  return std::make_unique<BoundarySize>(std::move(background), std::move(log_delta));
}

}  // namespace delquad
