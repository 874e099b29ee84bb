#include "features/symmetry/mirror_match.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/parallel.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {
namespace {

/// So many places of a face or a curve are compared with the true surface.
constexpr std::size_t kTruePlaces = 64;

/// How far each line may lie off the curve that it stands for: its length times the turn at its ends.
std::vector<double> bends_of_lines(const Mesh& mesh) {
  std::vector<std::vector<int>> at(mesh.points.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) at[v].push_back(static_cast<int>(l));
  const auto other = [&](int l, int v) {
    return mesh.lines[l][0] == v ? mesh.lines[l][1] : mesh.lines[l][0];
  };
  std::vector<double> bends;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    double turn = 0;
    for (const int v : mesh.lines[l])
      if (at[v].size() == 2 && mesh.line_curve[at[v][0]] == mesh.line_curve[at[v][1]])
        turn = std::max(turn, turn_angle(mesh.points[other(at[v][0], v)], mesh.points[v],
                                         mesh.points[other(at[v][1], v)]));
    bends.push_back(turn / 4 * norm(mesh.points[mesh.lines[l][1]] - mesh.points[mesh.lines[l][0]]));
  }
  return bends;
}

Vec3 area_of(const Mesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
}

/// How far each triangle may lie off the surface that it stands for.
std::vector<double> bends_of_triangles(const Mesh& mesh, const std::vector<double>& line_bends) {
  std::map<std::array<int, 2>, double> on_line;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    on_line[{std::min(mesh.lines[l][0], mesh.lines[l][1]), std::max(mesh.lines[l][0], mesh.lines[l][1])}] =
        line_bends[l];
  const std::vector<int> twin = side_twins(mesh);
  std::vector<double> bends(mesh.triangles.size(), 0);
  for (int s = 0; s < static_cast<int>(twin.size()); ++s) {
    const int a = side_start(mesh, s), b = side_end(mesh, s), t = s / 3;
    if (const auto line = on_line.find({std::min(a, b), std::max(a, b)}); line != on_line.end()) {
      bends[t] = std::max(bends[t], line->second);
      continue;
    }
    if (twin[s] < 0) continue;
    const Vec3 m = area_of(mesh, t), n = area_of(mesh, twin[s] / 3);
    const double angle = std::atan2(norm(cross(m, n)), dot(m, n));
    double longest = 0;
    for (int side = 3 * t; side < 3 * t + 3; ++side)
      longest =
          std::max(longest, norm(mesh.points[side_end(mesh, side)] - mesh.points[side_start(mesh, side)]));
    bends[t] = std::max(bends[t], angle / 2 * longest);
  }
  return bends;
}

std::string label(const char* kind, const Entity& entity) {
  return fmt::format("{} {}{}", kind, entity.tag,
                     entity.names.empty() ? "" : fmt::format(" '{}'", entity.names[0]));
}

}  // namespace

struct MirrorMatcher::Tables {
  explicit Tables(const SurfaceModel& m)
      : model(m),
        mesh(m.fine),
        diagonal(delquad::diagonal(m.fine)),
        line_bends(bends_of_lines(mesh)),
        bends(bends_of_triangles(mesh, line_bends)),
        all(mesh.points, mesh.triangles),
        faces(mesh.regions.size()),
        is_whisker(mesh.curves.size(), 0),
        is_seam(mesh.curves.size(), 0),
        faces_of(mesh.curves.size()),
        lines_of(mesh.curves.size()) {
    fill_faces();
    fill_tolerances();
    fill_curves();
    fill_points();
  }

  struct Face {
    std::vector<int> points, triangles;  // of the mesh
    std::optional<NearestTriangle> nearest;
    Box<Vec3> box{};
    double bend = 0;
    double tolerance = 0;
  };

  void fill_faces() {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Face& face = faces[mesh.triangle_region[t]];
      face.triangles.push_back(static_cast<int>(t));
      face.bend = std::max(face.bend, bends[t]);
      face.points.insert(face.points.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    std::vector<int> local(mesh.points.size(), -1);
    for (Face& face : faces) {
      if (face.triangles.empty()) continue;
      sort_unique(face.points);
      std::vector<Vec3> points;
      for (const int p : face.points) {
        local[p] = static_cast<int>(points.size());
        points.push_back(mesh.points[p]);
      }
      std::vector<std::array<int, 3>> triangles;
      for (const int t : face.triangles) {
        const auto& [a, b, c] = mesh.triangles[t];
        triangles.push_back({local[a], local[b], local[c]});
      }
      face.box = Box<Vec3>::around(std::span(points));
      face.nearest.emplace(std::move(points), std::move(triangles));
    }
  }

  /// Within the tolerance a narrow face could be anywhere: of such it is less.
  void fill_tolerances() {
    const std::vector<int> twin = side_twins(mesh);
    std::vector<double> area(faces.size(), 0), outline(faces.size(), 0);
    for (int s = 0; s < static_cast<int>(twin.size()); ++s) {
      const int face = mesh.triangle_region[s / 3];
      if (s % 3 == 0) area[face] += norm(area_of(mesh, s / 3)) / 2;
      if (twin[s] < 0 || mesh.triangle_region[twin[s] / 3] != face)
        outline[face] += norm(mesh.points[side_end(mesh, s)] - mesh.points[side_start(mesh, s)]);
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      faces[f].tolerance = kSymmetric * diagonal;
      // Of a long strip this is its width.
      if (outline[f] > 0)
        faces[f].tolerance = std::min(faces[f].tolerance, kSymmetricOfWidth * 2 * area[f] / outline[f]);
    }
  }

  void fill_curves() {
    for (const EmbeddedCurve& e : model.embedded) is_whisker[e.curve] = e.is_whisker;
    std::vector<Box<Vec3>> boxes;
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      const auto& [a, b] = mesh.lines[l];
      boxes.push_back(Box<Vec3>::around({mesh.points[a], mesh.points[b]}));
      const int curve = mesh.line_curve[l];
      lines_of[curve].push_back(static_cast<int>(l));
      const std::span<const HalfEdge> here = sides_of_edge(sides, a, b);
      for (const HalfEdge& side : here) faces_of[curve].push_back(mesh.triangle_region[side.element]);
      is_seam[curve] =
          here.size() == 2 && mesh.triangle_region[here[0].element] == mesh.triangle_region[here[1].element];
    }
    for (std::vector<int>& some : faces_of) {
      sort_unique(some);
    }
    lines = BoxTree<Vec3>(boxes);
    curve_tolerance.assign(mesh.curves.size(), kSymmetric * diagonal);
    for (std::size_t c = 0; c < faces_of.size(); ++c)
      for (const int f : faces_of[c]) curve_tolerance[c] = std::min(curve_tolerance[c], faces[f].tolerance);
  }

  /// Where two whiskers begin, and no other curve is.
  void fill_points() {
    std::vector<int> whisker_at(mesh.points.size(), -1);
    std::vector<char> is_single(mesh.points.size(), 0), is_on_curve(mesh.points.size(), 0);
    for (std::size_t l = 0; l < mesh.lines.size(); ++l)
      for (const int v : mesh.lines[l]) {
        const int curve = mesh.line_curve[l];
        if (!is_whisker[curve]) is_on_curve[v] = 1;
        if (whisker_at[v] >= 0 && whisker_at[v] != curve) is_single[v] = 1;
        whisker_at[v] = curve;
      }
    for (const int p : model.corners)
      if (is_single[p] && !is_on_curve[p]) single_points.push_back(p);
  }

  struct Off {
    double distance = 0;
    Vec3 at{};
    bool is_on = true;  // within the tolerance
  };

  /// How far the image of face f is from face g, where that is worst.
  Off compare(int f, int g, const SymmetryPlanes& planes, int plane) const {
    Off worst;
    const Face &face = faces[f], &other = faces[g];
    const std::size_t step = 1 + face.points.size() / kTruePlaces;
    for (std::size_t i = 0; i < face.points.size(); ++i) {
      const Vec3 x = planes.reflect(plane, mesh.points[face.points[i]]);
      const NearestTriangle::Found found = other.nearest->find(x);
      double distance = found.distance, allowed = face.tolerance + bends[other.triangles[found.triangle]];
      if (model.projector && i % step == 0 && distance <= allowed) {
        distance = norm(model.projector->to_face(g, x) - x);
        allowed = face.tolerance;
      }
      if (distance > allowed) worst.is_on = false;
      if (distance > allowed && distance > worst.distance) worst = {distance, x, false};
    }
    return worst;
  }

  bool looks_away(int f, int g, const SymmetryPlanes& planes, int plane) const {
    const Face &face = faces[f], &other = faces[g];
    double sum = 0;
    const std::size_t step = 1 + face.triangles.size() / kTruePlaces;
    for (std::size_t i = 0; i < face.triangles.size(); i += step) {
      const int t = face.triangles[i];
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 middle = (1.0 / 3) * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
      const int u = other.triangles[other.nearest->find(planes.reflect(plane, middle)).triangle];
      const Vec3 m = area_of(mesh, t), n = area_of(mesh, u);
      const Vec3 image = m - (2 * dot(m, planes.normal(plane))) * planes.normal(plane);
      sum += dot(image, n) / std::max(norm(n), 1e-300);
    }
    return sum < 0;
  }

  void match_face(int f, const SymmetryPlanes& planes, int plane, MirrorMatch& match, Off& off) const {
    const Face& face = faces[f];
    if (face.triangles.empty()) return;
    std::vector<Vec3> images;
    for (const int p : face.points) images.push_back(planes.reflect(plane, mesh.points[p]));
    const Box<Vec3> box = Box<Vec3>::around(std::span(images));
    match.face[f] = -1;
    off = {-1, {}, false};
    for (int g = 0; g < static_cast<int>(faces.size()); ++g) {
      if (faces[g].triangles.empty()) continue;
      const double slack = face.tolerance + face.bend + faces[g].bend;
      const Vec3 low = box.low - faces[g].box.low, high = box.high - faces[g].box.high;
      if (std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y),
                    std::abs(high.z)}) > slack)
        continue;
      const Off here = compare(f, g, planes, plane);
      if (!here.is_on) {
        if (off.distance < 0 || here.distance < off.distance) off = here;
        continue;
      }
      const bool turned = looks_away(f, g, planes, plane);
      if (match.face[f] >= 0 && (turned || !match.turned[f])) continue;
      match.face[f] = g;
      match.turned[f] = turned;
      off = {};
      if (!turned) return;
    }
  }

  /// Says why. `off`: from the face that is most like it, if there is one.
  std::string no_image(int f, const SymmetryPlanes& planes, int plane, const Off& off) const {
    Off worst;
    std::set<int> hit;
    for (const int p : faces[f].points) {
      const Vec3 x = planes.reflect(plane, mesh.points[p]);
      const NearestTriangle::Found found = all.find(x);
      hit.insert(mesh.regions[mesh.triangle_region[found.triangle]].tag);
      if (found.distance > std::max(worst.distance, faces[f].tolerance + bends[found.triangle]))
        worst = {found.distance, x, false};
    }
    const std::string face = label("face", mesh.regions[f]);
    if (worst.is_on && off.distance > 0) worst = off;
    if (!worst.is_on && worst.distance > 0)
      return fmt::format("the mirror image of {} is {:.3g} away from {} at {}: expected at most {:.3g}", face,
                         worst.distance, worst.at == off.at ? "any face like it" : "the model",
                         show_point(worst.at), faces[f].tolerance);
    return fmt::format(
        "no face of the model has the outline of the mirror image of {}, which lies on face(s) {}", face,
        fmt::join(hit, ", "));
  }

  std::string match_curves(const SymmetryPlanes& planes, int plane, MirrorMatch& match) const {
    std::map<std::vector<int>, std::vector<int>> by_faces;
    for (std::size_t c = 0; c < faces_of.size(); ++c) by_faces[faces_of[c]].push_back(static_cast<int>(c));
    std::vector<char> is_embedded(mesh.curves.size(), 0), may_be(mesh.curves.size(), 0);
    for (const EmbeddedCurve& e : model.embedded) is_embedded[e.curve] = 1;
    int worst = -1;  // of those without an image; curves of the model before embedded ones
    Off farthest;
    for (int c = 0; c < static_cast<int>(mesh.curves.size()); ++c) {
      if (is_whisker[c] || lines_of[c].empty()) continue;
      check_cancelled();
      std::vector<int> images;
      for (const int f : faces_of[c]) images.push_back(match.face[f]);
      std::ranges::sort(images);
      const auto among = by_faces.find(images);
      if (among != by_faces.end())
        for (const int other : among->second) may_be[other] = !is_whisker[other];
      const Off off = match_curve(c, planes, plane, may_be, match.curves[c]);
      if (among != by_faces.end())
        for (const int other : among->second) may_be[other] = 0;
      if (off.is_on) continue;
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
      for (const int other : std::vector<int>(match.curves[c]))
        if (std::ranges::find(match.curves[other], c) == match.curves[other].end())
          match.curves[other].push_back(c);
    for (std::vector<int>& some : match.curves) std::ranges::sort(some);
    if (worst < 0) return {};
    match.by_embedded = is_embedded[worst] != 0;
    return no_image(worst, farthest);
  }

  /// How far the image of a curve is from those that it may be, and which of them it lies on.
  Off match_curve(int c, const SymmetryPlanes& planes, int plane, const std::vector<char>& may_be,
                  std::vector<int>& found) const {
    Off worst;
    const std::size_t step = 1 + lines_of[c].size() / kTruePlaces;
    for (std::size_t i = 0; i < lines_of[c].size(); ++i) {
      const int l = lines_of[c][i];
      const Vec3 a = mesh.points[mesh.lines[l][0]], b = mesh.points[mesh.lines[l][1]];
      for (const double t : {0.0, 0.5, 1.0}) {
        const Vec3 x = planes.reflect(plane, a + t * (b - a));
        double best2 = std::numeric_limits<double>::infinity();
        int nearest = -1;
        lines.nearest(x, best2, [&](int other) {
          if (!may_be[mesh.line_curve[other]]) return;
          const auto& [p, q] = mesh.lines[other];
          const double d = distance_to_segment(x, mesh.points[p], mesh.points[q]);
          if (d * d < best2) best2 = d * d, nearest = other;
        });
        if (nearest < 0) return {std::numeric_limits<double>::infinity(), x, false};
        double distance = std::sqrt(best2),
               allowed = curve_tolerance[c] + line_bends[l] + line_bends[nearest];
        const int curve = mesh.line_curve[nearest];
        if (model.projector && t == 0 && i % step == 0 && distance <= allowed) {
          distance = norm(model.projector->to_curve(curve, x) - x);
          allowed = curve_tolerance[c];
        }
        if (distance > allowed && !(distance < worst.distance)) worst = {distance, x, false};
        if (t == 0.5 && std::ranges::find(found, curve) == found.end()) found.push_back(curve);
      }
    }
    return worst;
  }

  std::string no_image(int c, const Off& off) const {
    const std::string curve = label("curve", mesh.curves[c]), where = show_point(off.at);
    if (!std::isfinite(off.distance))
      return fmt::format("no curve is the mirror image of {} at {}", curve, where);
    return fmt::format("the mirror image of {} is {:.3g} away from curves at {}: expected at most {:.3g}",
                       curve, off.distance, where, curve_tolerance[c]);
  }

  /// Each single point needs another one as its image.
  std::string match_points(const SymmetryPlanes& planes, int plane) const {
    for (const int p : single_points) {
      const Vec3 at = mesh.points[p], image = planes.reflect(plane, at);
      if (std::ranges::any_of(single_points, [&](int other) {
            return norm(mesh.points[other] - image) <= kSymmetric * diagonal;
          }))
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
  double diagonal;
  std::vector<double> line_bends, bends;
  NearestTriangle all;
  std::vector<Face> faces;
  BoxTree<Vec3> lines;
  std::vector<char> is_whisker, is_seam;  // of each curve
  std::vector<double> curve_tolerance;
  std::vector<int> single_points;                    // in faces
  std::vector<std::vector<int>> faces_of, lines_of;  // of each curve
};

MirrorMatcher::MirrorMatcher(const SurfaceModel& model) : tables_(std::make_unique<Tables>(model)) {}
MirrorMatcher::~MirrorMatcher() = default;

MirrorMatch MirrorMatcher::match(const SymmetryPlanes& planes, int plane) const {
  const Tables& t = *tables_;
  const std::size_t n = t.faces.size();
  MirrorMatch match{{},
                    std::vector<int>(n),
                    std::vector<char>(n, 0),
                    std::vector<std::vector<int>>(t.mesh.curves.size()),
                    std::vector<char>(t.mesh.curves.size(), 0),
                    false};
  for (std::size_t f = 0; f < n; ++f) match.face[f] = static_cast<int>(f);
  std::vector<Tables::Off> offs(n);
  parallel_for(
      n, [&](std::size_t f) { t.match_face(static_cast<int>(f), planes, plane, match, offs[f]); },
      [&](std::size_t f) { return static_cast<double>(t.faces[f].points.size()); });
  int worst = -1;
  for (int f = 0; f < static_cast<int>(n); ++f) {
    if (match.face[f] >= 0 && match.face[match.face[f]] == f) continue;
    if (worst < 0 || offs[f].distance > offs[worst].distance) worst = f;
  }
  match.failure =
      worst < 0 ? t.match_curves(planes, plane, match) : t.no_image(worst, planes, plane, offs[worst]);
  if (match.failure.empty()) {
    match.failure = t.match_points(planes, plane);
    match.by_embedded = !match.failure.empty();
  }
  return match;
}

bool MirrorMatcher::may_be(const SymmetryPlanes& planes, int plane) const {
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
    // What does not matter stays as it is.
    a.diagonal().array() += 1e-9 * (a.trace() + 1e-300);
    const Eigen::Vector3d change = a.ldlt().solve(b);
    at.point = at.point + (change[2] * t.diagonal) * n;
    at.normal = n + change[0] * u + change[1] * v;
    at.normal = (1 / norm(at.normal)) * at.normal;
  }
  return at;
}

}  // namespace delquad
