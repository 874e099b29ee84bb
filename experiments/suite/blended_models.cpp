#include <algorithm>
#include <cmath>

#include "experiments/suite/random.h"
#include "experiments/suite/triangle_models.h"
#include "experiments/suite/triangle_tools.h"

namespace delquad {
namespace {

/// The smaller of two distances, rounded where they differ by less than `blend`.
double smooth_least(double a, double b, double blend) {
  const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - near * near * blend / 4;
}

double three_tori(const Vec3& p) {
  constexpr double kRadius = 0.8, kTube = 0.3, kApart = 1.95;
  double least = 10;
  for (const double x : {-kApart, 0.0, kApart}) {
    const Vec2 in_plane = {norm(Vec2{p.x - x, p.y}) - kRadius, p.z};
    least = smooth_least(least, norm(in_plane) - kTube, 0.25);
  }
  return least;
}

Mesh three_blended_tori() { return zero_surface(three_tori, {-3.3, -1.3, -0.5}, {3.3, 1.3, 0.5}, 0.083); }

/// Heights on a lattice of random values, twice as fine and half as high each time.
class Heights {
 public:
  explicit Heights(std::uint64_t seed) {
    Random random(seed);
    for (double& value : values_) value = random.between(-1, 1);
  }
  double at(double x, double y) const {
    double sum = 0, scale = 1;
    for (int octave = 0; octave < 3; ++octave, scale *= 2)
      sum += layer(x * scale, y * scale) / (scale * scale);
    return sum;
  }

 private:
  static constexpr int kSide = 32;
  double layer(double x, double y) const {
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double s = smooth(x - i), t = smooth(y - j);
    const auto value = [&](int a, int b) { return values_[a % kSide * kSide + b % kSide]; };
    return (1 - s) * ((1 - t) * value(i, j) + t * value(i, j + 1)) +
           s * ((1 - t) * value(i + 1, j) + t * value(i + 1, j + 1));
  }
  std::array<double, kSide * kSide> values_;
};

/// 90 x 60 quads over 3 x 2, their points off a grid, split either way.
Mesh ground(std::uint64_t seed) {
  constexpr int kAlong = 90, kAcross = 60;
  constexpr double kStep = 3.0 / kAlong, kOff = 0.28, kHeight = 0.35;
  const Heights heights(seed);
  Random random(seed + 1);
  Mesh mesh;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j <= kAcross; ++j) {
      const bool inner = i > 0 && j > 0 && i < kAlong && j < kAcross;
      const double dx = random.between(-kOff, kOff), dy = random.between(-kOff, kOff);
      const double x = kStep * (i + inner * dx), y = kStep * (j + inner * dy);
      mesh.points.push_back({x, y, kHeight * heights.at(2 * x, 2 * y)});
    }
  const auto index = [](int i, int j) { return i * (kAcross + 1) + j; };
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      random.between(0, 1) < 0.5 ? add_quad(mesh, a, b, c, d) : add_quad(mesh, b, c, d, a);
    }
  return mesh;
}

}  // namespace

/// Three handles, with the slivers of its making.
Mesh make_genus3() { return rounded(three_blended_tori()); }

Mesh make_genus3_noisy() {
  Mesh mesh = three_blended_tori();
  shake(mesh, 0.0015, 16);
  return rounded(std::move(mesh));
}

/// Balls along a random walk, with necks between them.
Mesh make_blobs() {
  Random random(17);
  std::vector<Ball> balls = {{{0, 0, 0}, 0.5}};
  while (balls.size() < 9) {
    const Ball& last = balls.back();
    const Vec3 step = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double length = norm(step), radius = random.between(0.28, 0.5);
    if (length < 0.2 || length > 1) continue;
    balls.push_back({last.centre + 0.95 * (last.radius + radius) / length * step, radius});
  }
  Vec3 low = balls[0].centre, high = low;
  for (const auto& [c, r] : balls) {
    low = {std::min(low.x, c.x - r), std::min(low.y, c.y - r), std::min(low.z, c.z - r)};
    high = {std::max(high.x, c.x + r), std::max(high.y, c.y + r), std::max(high.z, c.z + r)};
  }
  const auto distance = [&](const Vec3& p) {
    double least = 10;
    for (const auto& [c, r] : balls) least = smooth_least(least, norm(p - c) - r, 0.2);
    return least;
  };
  const Vec3 margin = {0.15, 0.15, 0.15};
  return rounded(zero_surface(distance, low - margin, high + margin, 0.065));
}

Mesh make_terrain() { return rounded(ground(18)); }

Mesh make_terrain_holes() {
  Mesh mesh = ground(20);
  std::vector<Ball> balls;
  for (const auto& [x, y, r] :
       {std::array{0.6, 0.5, 0.22}, {1.2, 1.4, 0.3}, {1.9, 0.7, 0.25}, {2.5, 1.5, 0.18}})
    for (double z = -1; z <= 1; z += 0.05) balls.push_back({{x, y, z}, r});
  cut_holes(mesh, balls);
  return rounded(std::move(mesh));
}

}  // namespace delquad
