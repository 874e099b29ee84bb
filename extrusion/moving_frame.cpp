#include "extrusion/moving_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "delquad/error.h"
#include "extrusion/section.h"

namespace delquad {

namespace {

/// Segments that turn by less follow a smooth curve: as curves have corners in surfaces that are read.
const double kSmoothCosine = std::cos(40 * std::numbers::pi / 180);
/// The sum of unit vectors that is too short to tell a direction: turns of 179 degrees.
constexpr double kTurnsBack = 0.0175;

Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

std::vector<Vec3> tangents_of(const std::vector<Vec3>& line) {
  std::vector<Vec3> along;  // the segments
  for (std::size_t i = 1; i < line.size(); ++i) along.push_back(unit(line[i] - line[i - 1]));
  std::vector<Vec3> tangents = {along.front()};
  for (std::size_t i = 1; i < along.size(); ++i) {
    const Vec3 sum = along[i - 1] + along[i];
    if (norm(sum) < kTurnsBack) throw InputError("the curve turns back at " + place(line[i]));
    tangents.push_back(unit(sum));
  }
  tangents.push_back(along.back());
  // A circle's tangents at both ends of a chord are mirror images.
  const std::size_t n = along.size();
  const auto mirrored = [](const Vec3& t, const Vec3& chord) { return unit(2 * dot(t, chord) * chord - t); };
  if (n > 1 && dot(along[0], along[1]) > kSmoothCosine) tangents[0] = mirrored(tangents[1], along[0]);
  if (n > 1 && dot(along[n - 2], along[n - 1]) > kSmoothCosine)
    tangents[n] = mirrored(tangents[n - 1], along[n - 1]);
  return tangents;
}

}  // namespace

Vec3 unit_across(const Vec3& v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  const Vec3 least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  return unit(cross(v, least));
}

void check_open_line(const std::vector<Vec3>& line) {
  if (line.size() < 2)
    throw InputError(fmt::format("the curve has {} points: expected at least 2", line.size()));
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i] == line[i - 1])
      throw InputError("the curve has the same point twice in a row at " + place(line[i]));
  if (line.front() == line.back())
    throw InputError("the curve closes at " + place(line[0]) + ": expected one with two ends");
}

std::vector<Vec3> points_at_lengths(const std::vector<Vec3>& line, const std::vector<double>& parts) {
  std::vector<double> lengths = {0};
  for (std::size_t i = 1; i < line.size(); ++i)
    lengths.push_back(lengths.back() + norm(line[i] - line[i - 1]));
  std::vector<Vec3> points;
  for (const double part : parts) {
    const double at = part * lengths.back();
    const auto next = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, at);
    const auto i = static_cast<std::size_t>(next - lengths.begin());
    const double t = std::min(1.0, (at - lengths[i - 1]) / (lengths[i] - lengths[i - 1]));
    points.push_back(t == 1 ? line[i] : line[i - 1] + t * (line[i] - line[i - 1]));
  }
  return points;
}

std::vector<Frame> moving_frames(const std::vector<Vec3>& line) {
  check_open_line(line);
  const std::vector<Vec3> tangents = tangents_of(line);
  const Vec3 first = unit_across(tangents[0]);
  std::vector<Frame> frames = {{tangents[0], first, cross(tangents[0], first)}};
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    const Frame& from = frames.back();
    const Vec3 axis = cross(from.tangent, tangents[i]);  // as long as the angle's sine
    const double cosine = dot(from.tangent, tangents[i]);
    const auto turn = [&](const Vec3& v) {
      const Vec3 once = cross(axis, v);
      return v + once + (1 / (1 + cosine)) * cross(axis, once);
    };
    if (1 + cosine < kTurnsBack) throw InputError("the curve turns back at " + place(line[i]));
    // Kept at right angles, however many points there are.
    const Vec3 turned = turn(from.first);
    const Vec3 next = unit(turned - dot(turned, tangents[i]) * tangents[i]);
    frames.push_back({tangents[i], next, cross(tangents[i], next)});
  }
  return frames;
}

}  // namespace delquad
