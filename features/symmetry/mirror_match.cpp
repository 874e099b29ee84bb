// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/mirror_match.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/parallel.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// So many places of a face or a curve are compared with the true surface.
constexpr std::size_t kCheckedPlaces = 64;

/// How far each line may lie off the curve that it stands for: its length times the turn at its ends.
std::vector<double> bends_of_lines(const SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::vector<std::vector<int>> at(mesh.points.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) at[v].push_back(static_cast<int>(l));
  const auto other = [&](int l, int v) {
    return mesh.lines[l][0] == v ? mesh.lines[l][1] : mesh.lines[l][0];
  };
  std::vector<double> bends;
  for (const auto& line : mesh.lines) {
    double turn = 0;
    for (const int v : line)
      if (at[v].size() == 2 && mesh.line_curve[at[v][0]] == mesh.line_curve[at[v][1]] &&
          !std::ranges::binary_search(model.corners, v))
        turn = std::max(turn, turn_angle(mesh.points[other(at[v][0], v)], mesh.points[v],
                                         mesh.points[other(at[v][1], v)]));
    bends.push_back(turn / 4 * norm(mesh.points[line[1]] - mesh.points[line[0]]));
  }
  return bends;
}

Vec3 area_of(const Mesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
}

std::string label(const char* kind, const Entity& entity) {
  return fmt::format("{} {}{}", kind, entity.tag,
                     entity.names.empty() ? "" : fmt::format(" '{}'", entity.names[0]));
}

}  // namespace

struct MirrorMatcher::Tables {
  Tables(const SurfaceModel& m, double part)
      : model(m),
        mesh(m.fine),
        diagonal(delquad::diagonal(m.fine)),
        largest(part * diagonal),
        all(mesh.points, mesh.triangles),
        line_bends(bends_of_lines(m)),
        bends(mesh.triangles.size(), 0),
        triangles_of(mesh.regions.size()),
        tolerance(mesh.regions.size(), largest),
        is_dangling(mesh.curves.size(), 0),
        is_embedded(mesh.curves.size(), 0),
        is_seam(mesh.curves.size(), 0),
        lines_of(mesh.curves.size()),
        curve_tolerance(mesh.curves.size(), largest) {
    fill_faces_and_curves();
    fill_points();
  }

  void fill_faces_and_curves() {
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
    const auto length = [&](int a, int b) { return norm(mesh.points[b] - mesh.points[a]); };
    const auto face_of = [&](const HalfEdge& side) { return mesh.triangle_region[side.element]; };
    std::vector<double> area(triangles_of.size(), 0), outline(triangles_of.size(), 0);
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      triangles_of[mesh.triangle_region[t]].push_back(t);
      area[mesh.triangle_region[t]] += norm(area_of(mesh, t)) / 2;
    }
    for (const EmbeddedCurve& e : model.embedded) {
      is_embedded[e.curve] = 1;
      is_dangling[e.curve] = e.is_dangling;
    }
    std::set<std::array<int, 2>> has_line;
    std::vector<Box<Vec3>> boxes;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const auto& [a, b] = mesh.lines[l];
      boxes.push_back(Box<Vec3>::around({mesh.points[a], mesh.points[b]}));
      has_line.insert({std::min(a, b), std::max(a, b)});
      const int curve = mesh.line_curve[l];
      lines_of[curve].push_back(static_cast<int>(l));
      const std::span<const HalfEdge> here = sides_of_edge(sides, a, b);
      is_seam[curve] = here.size() == 2 && face_of(here[0]) == face_of(here[1]);
      for (const HalfEdge& side : here) {
        bends[side.element] = std::max(bends[side.element], line_bends[l]);
        if (!is_seam[curve]) outline[face_of(side)] += length(a, b);
      }
    }
    lines = BoxTree<Vec3>(boxes);
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2 || has_line.contains({edge[0].lo, edge[0].hi})) return;
      const Vec3 m = area_of(mesh, edge[0].element), n = area_of(mesh, edge[1].element);
      const double angle = std::atan2(norm(cross(m, n)), dot(m, n));
      for (const HalfEdge& side : edge) {
        const auto& [a, b, c] = mesh.triangles[side.element];
        bends[side.element] =
            std::max(bends[side.element], angle / 2 * std::max({length(a, b), length(b, c), length(c, a)}));
      }
    });
    // Within the tolerance a narrow face could be anywhere: less for it, by the width that it has as a strip.
    for (std::size_t f = 0; f < triangles_of.size(); ++f)
      if (outline[f] > 0) tolerance[f] = std::min(tolerance[f], kSymmetricOfWidth * 2 * area[f] / outline[f]);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      for (const HalfEdge& side : sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]))
        curve_tolerance[mesh.line_curve[l]] =
            std::min(curve_tolerance[mesh.line_curve[l]], tolerance[face_of(side)]);
  }

  /// Named points without lines, and where two dangling curves begin and no other curve is.
  void fill_points() {
    std::vector<int> dangling_at(mesh.points.size(), -1);
    std::vector<char> is_single(mesh.points.size(), 0), is_on_curve(mesh.points.size(), 0);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      for (const int v : mesh.lines[l]) {
        const int curve = mesh.line_curve[l];
        if (!is_dangling[curve]) is_on_curve[v] = 1;
        if (dangling_at[v] >= 0 && dangling_at[v] != curve) is_single[v] = 1;
        dangling_at[v] = curve;
      }
    for (const int p : model.corners)
      if (is_single[p] && !is_on_curve[p]) single_points.push_back(p);
    for (const NamedPoint& n : mesh.named_points)
      if (dangling_at[n.point] < 0) single_points.push_back(n.point);
  }

  /// The place where an image is farthest off, beyond the tolerance.
  struct Deviation {
    double distance = 0;
    Vec3 at{};
    void add(double here, double allowed, const Vec3& x) {
      if (here > allowed && here > distance) *this = {here, x};
    }
  };

  /// The image of a face is the face that most images of its triangles are nearest to.
  Deviation match_face(int f, const SymmetryPlanes& planes, int plane, MirrorMatch& match) const {
    std::map<int, std::pair<double, double>> seen;  // of each face, the area seen, and how it looks
    for (const int t : triangles_of[f]) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 middle = (1.0 / 3) * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
      const int u = all.find(planes.reflect(plane, middle)).triangle;
      const Vec3 m = area_of(mesh, t), n = area_of(mesh, u), normal = planes.normal(plane);
      auto& [area, agrees] = seen[mesh.triangle_region[u]];
      area += norm(m);
      agrees += dot(m - (2 * dot(m, normal)) * normal, n) / std::max(norm(n), 1e-300);
    }
    const auto most = std::ranges::max_element(seen, {}, [](const auto& face) { return face.second.first; });
    match.face[f] = most->first;
    match.turned[f] = most->second.second < 0;
    Deviation off;
    std::vector<int> points;
    for (const int t : triangles_of[f])
      points.insert(points.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    sort_unique(points);
    const std::size_t step = 1 + points.size() / kCheckedPlaces;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 x = planes.reflect(plane, mesh.points[points[i]]);
      const NearestTriangle::Found found = all.find(x);
      const double allowed = tolerance[f] + bends[found.triangle];
      off.add(found.distance, allowed, x);
      if (model.projector && i % step == 0 && found.distance <= allowed)
        off.add(norm(model.projector->to_face(match.face[f], x) - x), tolerance[f], x);
    }
    return off;
  }

  /// The curves that the image of a curve lies on.
  Deviation match_curve(int c, const SymmetryPlanes& planes, int plane, std::vector<int>& images) const {
    Deviation off;
    const std::size_t step = 1 + lines_of[c].size() / kCheckedPlaces;
    for (std::size_t i = 0; i < lines_of[c].size(); ++i) {
      const int l = lines_of[c][i];
      const Vec3 a = mesh.points[mesh.lines[l][0]], b = mesh.points[mesh.lines[l][1]];
      for (const double t : {0.0, 0.5, 1.0}) {
        const Vec3 x = planes.reflect(plane, a + t * (b - a));
        double best2 = std::numeric_limits<double>::infinity();
        int nearest = -1;
        lines.nearest(x, best2, [&](int other) {
          if (is_dangling[mesh.line_curve[other]]) return;
          const auto& [p, q] = mesh.lines[other];
          const double d = distance_to_segment(x, mesh.points[p], mesh.points[q]);
          if (d * d < best2) best2 = d * d, nearest = other;
        });
        const double distance = std::sqrt(best2),
                     allowed = curve_tolerance[c] + line_bends[l] + line_bends[nearest];
        const int curve = mesh.line_curve[nearest];
        off.add(distance, allowed, x);
        if (model.projector && t == 0 && i % step == 0 && distance <= allowed)
          off.add(norm(model.projector->to_curve(curve, x) - x), curve_tolerance[c], x);
        if (t == 0.5 && std::ranges::find(images, curve) == images.end()) images.push_back(curve);
      }
    }
    return off;
  }

  /// Says what has no image, the model's faces and curves before embedded curves; empty: all have.
  std::string match_curves(const SymmetryPlanes& planes, int plane, MirrorMatch& match) const {
    int worst = -1;
    Deviation farthest;
    std::vector<char> is_crack(mesh.curves.size(), 0);
    for (const EmbeddedCurve& e : model.embedded) is_crack[e.curve] = e.is_crack;
    for (int c = 0; c < static_cast<int>(mesh.curves.size()); ++c) {
      if (is_dangling[c]) continue;
      check_cancelled();
      const Deviation off = match_curve(c, planes, plane, match.curves[c]);
      const auto other =
          std::ranges::find_if(match.curves[c], [&](int i) { return is_crack[i] != is_crack[c]; });
      if (off.distance == 0 && other != match.curves[c].end()) {
        match.by_embedded = true;
        return fmt::format("of {} and its mirror image {} one is a crack", label("curve", mesh.curves[c]),
                           label("curve", mesh.curves[*other]));
      }
      if (off.distance == 0) continue;
      match.curves[c].clear();
      if (is_seam[c] && !is_embedded[c] && mesh.curves[c].names.empty()) {
        match.is_loose_seam[c] = 1;
      } else if (worst < 0 || is_embedded[c] < is_embedded[worst] ||
                 (is_embedded[c] == is_embedded[worst] && off.distance > farthest.distance)) {
        worst = c;
        farthest = off;
      }
    }
    for (int c = 0; c < static_cast<int>(mesh.curves.size()); ++c)
      for (const int other : std::vector<int>(match.curves[c])) match.curves[other].push_back(c);
    for (std::vector<int>& some : match.curves) sort_unique(some);
    if (worst < 0) return {};
    match.by_embedded = is_embedded[worst] != 0;
    return fmt::format("the mirror image of {} is {:.3g} away from curves at {}: expected at most {:.3g}",
                       label("curve", mesh.curves[worst]), farthest.distance, show_point(farthest.at),
                       curve_tolerance[worst]);
  }

  std::string match_faces(const SymmetryPlanes& planes, int plane, MirrorMatch& match) const {
    std::vector<Deviation> offs(triangles_of.size());
    parallel_for(
        offs.size(),
        [&](std::size_t f) {
          match.face[f] = static_cast<int>(f);
          if (!triangles_of[f].empty()) offs[f] = match_face(static_cast<int>(f), planes, plane, match);
        },
        [&](std::size_t f) { return static_cast<double>(triangles_of[f].size()); });
    const auto far = std::ranges::max_element(offs, {}, &Deviation::distance);
    const auto f = far - offs.begin();
    if (far->distance > 0)
      return fmt::format(
          "the mirror image of {} is {:.3g} away from the model at {}: expected at most {:.3g}",
          label("face", mesh.regions[f]), far->distance, show_point(far->at), tolerance[f]);
    for (std::size_t g = 0; g < offs.size(); ++g)
      if (match.face[match.face[g]] != static_cast<int>(g))
        return fmt::format("{} is not the mirror image of {}, which lies on it",
                           label("face", mesh.regions[match.face[g]]), label("face", mesh.regions[g]));
    return {};
  }

  /// Each single point needs another one as its image.
  std::string match_points(const SymmetryPlanes& planes, int plane) const {
    for (const int p : single_points) {
      const Vec3 at = mesh.points[p], image = planes.reflect(plane, at);
      if (std::ranges::any_of(single_points,
                              [&](int other) { return norm(mesh.points[other] - image) <= largest; }))
        continue;
      std::string name;
      for (const NamedPoint& n : mesh.named_points)
        if (n.point == p && name.empty() && !n.entity.names.empty()) name = " '" + n.entity.names[0] + "'";
      return fmt::format("the point{} at {} has no mirror image at {}", name, show_point(at),
                         show_point(image));
    }
    return {};
  }

  const SurfaceModel& model;
  const Mesh& mesh;
  double diagonal, largest;  // tolerance of places
  NearestTriangle all;
  BoxTree<Vec3> lines;
  std::vector<double> line_bends, bends;
  std::vector<std::vector<int>> triangles_of;  // of each face
  std::vector<double> tolerance;
  std::vector<char> is_dangling, is_embedded, is_seam;  // of each curve
  std::vector<std::vector<int>> lines_of;
  std::vector<double> curve_tolerance;
  std::vector<int> single_points;  // in faces
};

MirrorMatcher::MirrorMatcher(const SurfaceModel& model, double tolerance)
    : tables_(std::make_unique<Tables>(model, tolerance)) {}
MirrorMatcher::~MirrorMatcher() = default;

MirrorMatch MirrorMatcher::match(const SymmetryPlanes& planes, int plane) const {
  const Tables& t = *tables_;
  const std::size_t n_faces = t.mesh.regions.size(), n_curves = t.mesh.curves.size();
  MirrorMatch match{{},
                    std::vector<int>(n_faces),
                    std::vector<char>(n_faces, 0),
                    std::vector<std::vector<int>>(n_curves),
                    std::vector<char>(n_curves, 0),
                    false};
  match.failure = t.match_faces(planes, plane, match);
  if (match.failure.empty()) match.failure = t.match_curves(planes, plane, match);
  if (match.failure.empty()) {
    match.failure = t.match_points(planes, plane);
    match.by_embedded = !match.failure.empty();
  }
  return match;
}

bool MirrorMatcher::can_match(const SymmetryPlanes& planes, int plane) const {
  constexpr double kRough = 1e-2;
  constexpr std::size_t kPlaces = 200;
  const Tables& t = *tables_;
  const std::size_t step = 1 + t.mesh.points.size() / kPlaces;
  for (std::size_t i = 0; i < t.mesh.points.size(); i += step) {
    const Vec3 x = planes.reflect(plane, t.mesh.points[i]);
    const NearestTriangle::Found found = t.all.find(x);
    if (found.distance > kRough * t.diagonal + t.bends[found.triangle]) return false;
  }
  return true;
}

double MirrorMatcher::misfit(const SymmetryPlane& plane) const {
  constexpr std::size_t kPlaces = 500;
  const Tables& t = *tables_;
  const SymmetryPlanes planes({plane});
  const std::size_t step = 1 + t.mesh.points.size() / kPlaces;
  double sum = 0;
  int places = 0;
  for (std::size_t i = 0; i < t.mesh.points.size(); i += step, ++places) {
    const Vec3 x = planes.reflect(0, t.mesh.points[i]);
    const NearestTriangle::Found found = t.all.find(x);
    const int face = t.mesh.triangle_region[found.triangle];
    sum += t.model.projector ? norm(t.model.projector->to_face(face, x) - x) : found.distance;
  }
  return sum / places;
}

SymmetryPlane MirrorMatcher::adjusted(const SymmetryPlane& plane) const {
  constexpr int kSteps = 5;
  constexpr std::size_t kPlaces = 2000;
  constexpr double kFar = 2e-2;  // of the diagonal
  const Tables& t = *tables_;
  const std::size_t step = 1 + t.mesh.points.size() / kPlaces;
  SymmetryPlane at = plane;
  at.normal = (1 / norm(at.normal)) * at.normal;
  for (int k = 0; k < kSteps; ++k) {
    const Vec3 n = at.normal;
    const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 u = cross(n, axis);
    u = (1 / norm(u)) * u;
    const Vec3 v = cross(n, u);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < t.mesh.points.size(); i += step) {
      const Vec3 from = t.mesh.points[i] - at.point;
      const double h = dot(n, from);
      const Vec3 x = t.mesh.points[i] - (2 * h) * n;
      const NearestTriangle::Found found = t.all.find(x);
      if (found.distance > kFar * t.diagonal) continue;
      const auto& corners = t.mesh.triangles[found.triangle];
      Vec3 y;
      for (int c = 0; c < 3; ++c) y = y + found.weights[c] * t.mesh.points[corners[c]];
      if (t.model.projector) y = t.model.projector->to_face(t.mesh.triangle_region[found.triangle], x);
      Vec3 normal = area_of(t.mesh, found.triangle);
      if (!(norm(normal) > 0)) continue;
      normal = (1 / norm(normal)) * normal;
      // Lengths in diagonals, so that turns and shifts weigh alike.
      const auto change = [&](const Vec3& turn, double shift) {
        return -2 * dot(normal, (dot(turn, from) - shift) * n + h * turn) / t.diagonal;
      };
      const Eigen::Vector3d row(change(u, 0), change(v, 0), change({}, t.diagonal));
      a += row * row.transpose();
      b -= row * (dot(normal, x - y) / t.diagonal);
    }
    // A small diagonal keeps changes at zero that do not matter.
    a.diagonal().array() += 1e-9 * (a.trace() + 1e-300);
    const Eigen::Vector3d change = a.ldlt().solve(b);
    at.point = at.point + (change[2] * t.diagonal) * n;
    at.normal = n + change[0] * u + change[1] * v;
    at.normal = (1 / norm(at.normal)) * at.normal;
  }
  return at;
}

}  // namespace delquad
