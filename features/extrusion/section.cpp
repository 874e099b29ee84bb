// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extrusion/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/turn_to_agree.h"

namespace delquad {

namespace {

void require_quads(const Mesh& mesh) {
  if (is_solid(mesh))
    refuse("the mesh has {} already: only meshes of quads are swept", solid_at(mesh, 0).shape->plural);
  if (mesh.order > 1)
    throw InputError(
        fmt::format("the mesh has elements of order {}: only quads of order 1 are swept", mesh.order));
  require_readable(mesh, "the mesh");
  if (!mesh.triangles.empty())
    throw InputError(fmt::format("the mesh has {} triangles beside {} quads: only meshes of quads are swept",
                                 mesh.triangles.size(), mesh.quads.size()));
  if (mesh.quads.empty()) throw InputError("the mesh has no quads to sweep");
  for (const auto& quad : mesh.quads)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        if (quad[i] == quad[j])
          throw InputError(
              fmt::format("a quad has two corners at the node {}", show_point(mesh.points[quad[i]])));
}

/// Turns quads over that run along an edge in the same direction as a neighbor that came first.
void orient(Section& section, std::span<const HalfEdge> sides) {
  std::vector<std::array<int, 4>>& quads = section.mesh.quads;
  const std::vector<Vec3>& points = section.mesh.points;
  std::vector<Neighbours> neighbours;
  std::vector<Vec3> middles;
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    const Vec3 middle = 0.5 * (points[at[0].lo] + points[at[0].hi]);
    if (at.size() > 2)
      throw InputError(
          fmt::format("{} quads share the edge at {}: only surfaces whose edges have one or two are swept",
                      at.size(), show_point(middle)));
    if (at.size() < 2) return;
    neighbours.push_back({at[0].element, at[1].element, at[0].forward != at[1].forward});
    middles.push_back(middle);
  });
  const Turned turned = turn_to_agree(quads.size(), neighbours);
  if (turned.clash >= 0)
    throw InputError(
        fmt::format("the surface has one side only, as a Moebius strip, and cannot be swept: see the edge at "
                    "{} [one-side]",
                    show_point(middles[turned.clash])));
  section.n_parts = static_cast<int>(turned.pieces.size());
  section.part.resize(quads.size());
  for (int p = 0; p < section.n_parts; ++p)
    for (const int q : turned.pieces[p]) section.part[q] = p;
  for (std::size_t q = 0; q < quads.size(); ++q)
    if (turned.is_turned[q]) std::swap(quads[q][1], quads[q][3]);
}

/// Takes out lines that are no edges of quads, and points that no quad has.
void drop_unrelated(Mesh& mesh, std::span<const HalfEdge> sides, ReadNotes* notes) {
  const std::size_t lines = drop_stray_lines(mesh, sides), names = mesh.named_points.size();
  drop_unused_points(mesh);
  if (notes == nullptr) return;
  if (lines > 0) notes->push_back(fmt::format("{} lines are no edges of quads and were left out", lines));
  if (const std::size_t lost = names - mesh.named_points.size(); lost > 0)
    notes->push_back(fmt::format("{} named points are no corners of quads and were left out", lost));
}

/// `sides` of the quads as they are oriented.
void find_walls(Section& section, std::span<const HalfEdge> sides) {
  const Mesh& mesh = section.mesh;
  const auto add = [&](const HalfEdge& side, int curve, bool on_boundary) {
    section.walls.push_back({side.forward ? side.lo : side.hi, side.forward ? side.hi : side.lo, side.element,
                             curve, on_boundary});
  };
  std::vector<std::pair<int, int>> with_line;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    const auto at = sides_of_edge(sides, a, b);
    if (at.size() > 1 && mesh.curves[mesh.line_curve[l]].names.empty()) continue;
    add(at[0], mesh.line_curve[l], at.size() == 1);
    with_line.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(with_line.begin(), with_line.end());
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    if (at.size() == 1 &&
        !std::binary_search(with_line.begin(), with_line.end(), std::pair(at[0].lo, at[0].hi)))
      add(at[0], -1, true);
  });
}

}  // namespace

Section make_section(const Mesh& given, ReadNotes* notes) {
  require_quads(given);
  Section section;
  section.mesh = given;
  if (notes != nullptr && (!given.periodic.empty() || !given.periodic_faces.empty()))
    notes->push_back("which nodes are images of others is not kept");
  section.mesh.periodic.clear();
  section.mesh.periodic_faces.clear();
  const std::vector<HalfEdge> sides = sorted_half_edges(section.mesh);
  orient(section, sides);
  drop_unrelated(section.mesh, sides, notes);
  find_walls(section, sorted_half_edges(section.mesh));
  return section;
}

namespace {

/// Segments that turn by less follow a smooth curve: as curves have corners in surfaces that are read.
const double kSmoothCosine = std::cos(40 * std::numbers::pi / 180);
/// The sum of unit vectors that is too short to tell a direction: turns of 179 degrees.
constexpr double kTurnsBack = 0.0175;

Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

std::vector<Vec3> segments_of(const std::vector<Vec3>& line) {
  std::vector<Vec3> along;
  for (std::size_t i = 1; i < line.size(); ++i) along.push_back(unit(line[i] - line[i - 1]));
  return along;
}

std::vector<Vec3> tangents_of(const std::vector<Vec3>& line, const std::vector<Vec3>& along) {
  std::vector<Vec3> tangents = {along.front()};
  for (std::size_t i = 1; i < along.size(); ++i) {
    const Vec3 sum = along[i - 1] + along[i];
    if (norm(sum) < kTurnsBack) throw InputError("the curve turns back at " + show_point(line[i]));
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
      throw InputError("the curve has the same point twice in a row at " + show_point(line[i]));
  if (line.front() == line.back())
    throw InputError("the curve closes at " + show_point(line[0]) + ": expected one with two ends");
}

std::vector<Vec3> points_at_lengths(const std::vector<Vec3>& line, const std::vector<double>& parts) {
  const std::vector<Vec3> along = segments_of(line);
  std::vector<double> lengths = {0};
  for (std::size_t i = 1; i < line.size(); ++i)
    lengths.push_back(lengths.back() + norm(line[i] - line[i - 1]));
  std::vector<double> at;
  for (const double part : parts) at.push_back(part * lengths.back());
  std::size_t next_free = 1;
  for (std::size_t i = 1; i < along.size(); ++i) {
    if (dot(along[i - 1], along[i]) > kSmoothCosine) continue;
    std::size_t nearest = next_free;
    while (nearest + 2 < at.size() &&
           std::abs(at[nearest + 1] - lengths[i]) < std::abs(at[nearest] - lengths[i]))
      ++nearest;
    const bool fits = nearest + 1 < at.size() && at[nearest - 1] < lengths[i] && lengths[i] < at[nearest + 1];
    if (!fits)
      throw InputError(
          fmt::format("{} layers are too few for the corners of the curve: none is left for that at {}",
                      parts.size() - 1, show_point(line[i])));
    at[nearest] = lengths[i];
    next_free = nearest + 1;
  }
  std::vector<Vec3> points;
  for (const double length : at) {
    const auto next = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
    const auto i = static_cast<std::size_t>(next - lengths.begin());
    const double t = std::min(1.0, (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]));
    points.push_back(t == 1 ? line[i] : line[i - 1] + t * (line[i] - line[i - 1]));
  }
  return points;
}

MovingSection::MovingSection(std::vector<Vec3> line) : line_(std::move(line)) {
  check_open_line(line_);
  const std::vector<Vec3> along = segments_of(line_);
  tangents_ = tangents_of(line_, along);
  const Vec3 first = unit_across(along[0]);
  frames_ = {{along[0], first, cross(along[0], first)}};
  for (std::size_t i = 1; i < along.size(); ++i) {
    const Frame& from = frames_.back();
    const Vec3 axis = cross(from.along, along[i]);  // as long as the angle's sine
    const Vec3 once = cross(axis, from.first);
    const Vec3 turned = from.first + once + (1 / (1 + dot(from.along, along[i]))) * cross(axis, once);
    // Kept at right angles, however many segments there are.
    const Vec3 next = unit(turned - dot(turned, along[i]) * along[i]);
    frames_.push_back({along[i], next, cross(along[i], next)});
  }
}

Vec3 MovingSection::place(const Vec3& p, std::size_t i) const {
  const Vec3 given = p - line_[0];
  const double height = dot(given, tangents_[0]);
  const Vec3 in_plane = given - height * tangents_[0];
  const Frame &from = frames_[0], &to = frames_[std::min(i, frames_.size() - 1)];
  const Vec3 profile = dot(in_plane, from.first) * to.first + dot(in_plane, from.second) * to.second;
  const double slide = dot(profile, tangents_[i]) / dot(to.along, tangents_[i]);
  return line_[i] + height * tangents_[i] + (profile - slide * to.along);
}

}  // namespace delquad
