#include "geometry/surface/curve_chains.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

/// The lines at each point.
class PointLines {
 public:
  explicit PointLines(const Mesh& mesh) : start_(mesh.points.size() + 1, 0), lines_(2 * mesh.lines.size()) {
    for (const auto& [a, b] : mesh.lines) {
      ++start_[a + 1];
      ++start_[b + 1];
    }
    for (size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (size_t i = 0; i < mesh.lines.size(); ++i) {
      for (const int p : mesh.lines[i]) lines_[next[p]++] = static_cast<int>(i);
    }
  }
  std::span<const int> at(int point) const {
    return std::span(lines_).subspan(start_[point], start_[point + 1] - start_[point]);
  }

 private:
  std::vector<int> start_, lines_;
};

/// Triangles at each line.
std::vector<std::size_t> triangles_on_lines(const Mesh& mesh) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<std::size_t> counts;
  for (const auto& [a, b] : mesh.lines) counts.push_back(sides_of_edge(sides, a, b).size());
  return counts;
}

int other_end(const std::array<int, 2>& line, int end) { return line[0] == end ? line[1] : line[0]; }

}  // namespace

double turn_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 in = b - a, out = c - b;
  return std::atan2(norm(cross(in, out)), dot(in, out));
}

void mark_turns(const Mesh& mesh, double angle, const std::vector<char>& among, std::vector<char>& corner) {
  const PointLines lines(mesh);
  for (int p = 0; p < static_cast<int>(mesh.points.size()); ++p) {
    const auto here = lines.at(p);
    if (!among[p] || here.size() != 2) continue;
    const int a = other_end(mesh.lines[here[0]], p), b = other_end(mesh.lines[here[1]], p);
    if (turn_angle(mesh.points[a], mesh.points[p], mesh.points[b]) > angle) corner[p] = 1;
  }
}

std::vector<std::vector<int>> chain_lines(SurfaceModel& model, const std::vector<int>& line_kind,
                                          std::vector<char> corner) {
  Mesh& mesh = model.fine;
  const PointLines lines(mesh);
  const std::vector<std::size_t> triangles = triangles_on_lines(mesh);
  const auto continues = [&](int line, int other) {
    return line_kind[line] == line_kind[other] && triangles[line] == triangles[other];
  };
  model.corners.clear();
  for (int p = 0; p < static_cast<int>(corner.size()); ++p) {
    const auto here = lines.at(p);
    if (here.empty()) continue;
    if (here.size() != 2 || !continues(here[0], here[1])) corner[p] = 1;
    if (corner[p]) model.corners.push_back(p);
  }

  std::vector<std::vector<int>> chains;
  std::vector<std::array<int, 2>> sorted;
  std::vector<int> curve_of;
  std::vector<char> done(mesh.lines.size(), 0);
  const auto follow = [&](int from, int line) {
    chains.emplace_back();
    while (!done[line]) {
      done[line] = 1;
      const int to = other_end(mesh.lines[line], from);
      chains.back().push_back(line);
      sorted.push_back({from, to});
      curve_of.push_back(static_cast<int>(chains.size()) - 1);
      if (corner[to]) break;
      const auto here = lines.at(to);
      line = here[0] == line ? here[1] : here[0];
      from = to;
    }
  };
  for (const int p : model.corners) {
    for (const int line : lines.at(p)) {
      if (!done[line]) follow(p, line);
    }
  }
  for (size_t i = 0; i < mesh.lines.size(); ++i) {
    if (!done[i]) follow(mesh.lines[i][0], static_cast<int>(i));
  }
  mesh.lines = std::move(sorted);
  mesh.line_curve = std::move(curve_of);
  return chains;
}

std::vector<Entity> entities_of_pieces(const std::vector<Entity>& given,
                                       const std::vector<int>& given_of_piece) {
  int greatest = 0;
  for (const int g : given_of_piece) {
    if (g >= 0) greatest = std::max(greatest, given[g].tag);
  }
  std::vector<char> taken(given.size(), 0);
  std::vector<Entity> entities;
  for (const int g : given_of_piece) {
    entities.push_back(g >= 0 ? given[g] : Entity{});
    if (g < 0 || taken[g]) {
      entities.back().tag = ++greatest;
    } else {
      taken[g] = 1;
    }
  }
  return entities;
}

}  // namespace delquad
