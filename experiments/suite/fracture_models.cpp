#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/segment.h"
#include "experiments/suite/model_text.h"
#include "experiments/suite/planar_models.h"
#include "experiments/suite/random.h"

namespace delquad {
namespace {

struct Segment {
  Vec2 a, b;
};

bool cross_each_other(const Segment& s, const Segment& t) {
  const auto side = [](const Segment& line, Vec2 p) { return cross(line.b - line.a, p - line.a) > 0; };
  return side(s, t.a) != side(s, t.b) && side(t, s.a) != side(t, s.b);
}

double distance(const Segment& s, const Segment& t) {
  if (cross_each_other(s, t)) return 0;
  return std::min({distance_to_segment(s.a, t.a, t.b), distance_to_segment(s.b, t.a, t.b),
                   distance_to_segment(t.a, s.a, s.b), distance_to_segment(t.b, s.a, s.b)});
}

/// What of a convex polygon lies left of the line from `a` along `direction`.
std::vector<Vec2> left_part(const std::vector<Vec2>& polygon, Vec2 a, Vec2 direction) {
  std::vector<Vec2> part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double at_p = cross(direction, p - a), at_q = cross(direction, q - a);
    if (at_p >= 0) part.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) part.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return part;
}

/// A convex polygon, counterclockwise, with every side moved inwards.
std::vector<Vec2> shrunk(const std::vector<Vec2>& polygon, double by) {
  std::vector<Vec2> inner = polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const Vec2 along = 1 / norm(q - p) * (q - p);
    inner = left_part(inner, p + by * perp(along), along);
  }
  return inner;
}

double area(const std::vector<Vec2>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

double shortest_side(const std::vector<Vec2>& polygon) {
  double least = norm(polygon.back() - polygon.front());
  for (std::size_t i = 1; i < polygon.size(); ++i) least = std::min(least, norm(polygon[i] - polygon[i - 1]));
  return least;
}

/// Cuts the largest of the blocks by a random line, unless that leaves a splinter.
void cut_largest(std::vector<std::vector<Vec2>>& blocks, Random& random) {
  constexpr double kShortest = 0.02;
  auto largest = std::ranges::max_element(blocks, {}, area);
  Vec2 middle;
  for (const Vec2& p : *largest) middle = middle + 1.0 / static_cast<double>(largest->size()) * p;
  const double angle = random.between(0, std::numbers::pi);
  const Vec2 along = {std::cos(angle), std::sin(angle)};
  const Vec2 from = middle + random.between(-0.06, 0.06) * perp(along);
  const std::vector<Vec2> left = left_part(*largest, from, along), right = left_part(*largest, from, -along);
  if (std::min(shortest_side(left), shortest_side(right)) < kShortest) return;
  *largest = left;
  blocks.push_back(right);
}

}  // namespace

/// Lenses with sharp ends that come close and do not cross.
std::string make_fractures() {
  constexpr int kCount = 24;
  constexpr double kGap = 0.02, kAperture = 0.05;  // the latter as a part of the length
  Random random(1);
  std::vector<Segment> segments;
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "rock"});
  while (segments.size() < kCount) {
    const double length = random.between(0.12, 0.5), angle = random.between(0, std::numbers::pi);
    const Vec2 half = length / 2 * Vec2{std::cos(angle), std::sin(angle)};
    const Vec2 middle = {random.between(0, 2), random.between(0, 1)};
    const Segment s = {middle - half, middle + half};
    const auto inside = [](Vec2 p) { return p.x > 0.03 && p.x < 1.97 && p.y > 0.03 && p.y < 0.97; };
    const double gap = kGap + kAperture * length;
    if (!inside(s.a) || !inside(s.b)) continue;
    if (std::ranges::any_of(segments, [&](const Segment& t) { return distance(s, t) < gap; })) continue;
    segments.push_back(s);
    const Vec2 up = kAperture * perp(half);
    model.polygon({s.a, middle - up, s.b, middle + up}, {"fracture", "filling"});
  }
  return model.text();
}

/// Channels that cross each other between the blocks of a broken plate.
std::string make_fracture_network() {
  constexpr int kBlocks = 32, kTrials = 400;
  constexpr double kAperture = 0.012;
  Random random(2);
  std::vector<std::vector<Vec2>> blocks = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}};
  for (int trial = 0; trial < kTrials && blocks.size() < kBlocks; ++trial) cut_largest(blocks, random);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "fractures"});
  for (const auto& block : blocks) model.polygon(shrunk(block, kAperture / 2), {"wall", "rock"});
  return model.text();
}

}  // namespace delquad
