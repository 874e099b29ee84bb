#include "fields/size_connection.h"

#include <cmath>

#include "fields/sample_triangle.h"

namespace delquad {

SizeConnection::SizeConnection(const TriPatch& tri, const ParametricSize& size) {
  int hint = -1;
  for (const Vec2 u : tri.points) log_size_.push_back(std::log(size.at(u, hint)));
  gradient_.reserve(tri.triangles.size());
  phase_turns_.reserve(tri.triangles.size());
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    const auto& v = tri.triangles[t];
    const Corners x = corners_of(tri, v), middle = middles(x);
    gradient_.push_back(slope(x, {log_size_[v[0]], log_size_[v[1]], log_size_[v[2]]}));
    const Vec2 centroid = (1.0 / 3) * (x[0] + x[1] + x[2]);
    auto& turns = phase_turns_.emplace_back();
    for (int k = 0; k < 3; ++k) turns[k] = 4 * turn(static_cast<int>(t), middle[k] - centroid);
  }
}

}  // namespace delquad
