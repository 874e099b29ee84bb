// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/imprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/cancel.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/mesh.h"
#include "features/embedded/dangling_edges.h"
#include "features/embedded/section_path.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/compound_projector.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {

namespace {

/// Parts of the model's diagonal: how far a line may be from the surface, and how near to a vertex or an edge
/// it runs.
constexpr double kFit = 1e-3, kSnap = 2e-7;
/// Part of the size: the least distance of two points.
constexpr double kApart = 1e-3;
/// Turn at which a curve of a file gets a node.
constexpr double kSharpTurn = 40 * std::numbers::pi / 180;

/// A place on a triangulation that changes: the nearest of the first triangles, of its parts the nearest.
class SplitTriangles {
 public:
  explicit SplitTriangles(const Mesh& mesh)
      : mesh_(mesh), nearest_(mesh.points, mesh.triangles), parts_(mesh.triangles.size()) {
    for (int t = 0; t < static_cast<int>(parts_.size()); ++t) {
      parts_[t] = {t};
      origin_.push_back(t);
    }
  }

  struct Found {
    int triangle = -1;
    std::array<double, 3> weights{};
    Vec3 at{};
    double distance = 0;
  };
  Found find(const Vec3& x, const SurfaceEditor& editor) {
    for (; n_splits_ < editor.splits().size(); ++n_splits_) {
      const int origin = origin_[editor.splits()[n_splits_].first];
      parts_[origin].push_back(editor.splits()[n_splits_].second);
      origin_.push_back(origin);
    }
    Found best;
    for (const int t : parts_[nearest_.find(x).triangle]) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const auto& p = mesh_.points;
      const auto w = nearest_weights(p[a], p[b], p[c], x);
      const Vec3 at = w[0] * p[a] + w[1] * p[b] + w[2] * p[c];
      if (best.triangle < 0 || norm(at - x) < best.distance) best = {t, w, at, norm(at - x)};
    }
    return best;
  }

 private:
  const Mesh& mesh_;
  NearestTriangle nearest_;
  std::vector<std::vector<int>> parts_;
  std::vector<int> origin_;
  std::size_t n_splits_ = 0;
};

/// Normals of a triangulation as it was: linear between those at the points, each the mean of one face's
/// triangles there, weighted by their angles. On a sphere they point to its center however it is divided.
class SmoothNormals {
 public:
  explicit SmoothNormals(const Mesh& mesh)
      : nearest_(mesh.points, mesh.triangles), region_(mesh.triangle_region) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 &x = mesh.points[mesh.triangles[t][k]], &y = mesh.points[mesh.triangles[t][(k + 1) % 3]],
                   &z = mesh.points[mesh.triangles[t][(k + 2) % 3]];
        const Vec3 area = cross(y - x, z - x);
        const double length = norm(area), angle = std::atan2(length, dot(y - x, z - x));
        if (!(length > 0)) continue;
        Vec3& sum = at_point_[key(mesh.triangles[t][k], region_[t])];
        sum = sum + (angle / length) * area;
      }
  }

  Vec3 at(const Vec3& x) const {
    const NearestTriangle::Found found = nearest_.find(x);
    Vec3 sum;
    for (int k = 0; k < 3; ++k) {
      const auto at = at_point_.find(key(nearest_.triangle(found.triangle)[k], region_[found.triangle]));
      if (at != at_point_.end() && norm(at->second) > 0)
        sum = sum + (found.weights[k] / norm(at->second)) * at->second;
    }
    return sum;
  }

 private:
  static long long key(int point, int region) { return static_cast<long long>(point) << 32 | region; }

  NearestTriangle nearest_;
  std::vector<int> region_;                       ///< of each triangle
  std::unordered_map<long long, Vec3> at_point_;  // only looked up, never iterated
};

class Imprinter {
 public:
  Imprinter(SurfaceModel& model, const SizeField& size)
      : model_(model),
        mesh_(model.fine),
        size_(size),
        diagonal_(delquad::diagonal(mesh_.points)),
        first_curve_(static_cast<int>(mesh_.curves.size())),
        editor_(model),
        places_(mesh_),
        normals_(mesh_) {}

  void run() {
    std::vector<Placed> placed;
    for (const LooseLine& line : model_.loose) {
      check_cancelled();
      if (auto nodes = place(line)) placed.push_back({&line, std::move(*nodes)});
    }
    check_apart(placed);
    for (const auto& [line, nodes] : placed)
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        check_cancelled();
        draw(*line, nodes[i], nodes[i + 1]);
      }
    add_dangling_edges(placed);
    for (const auto& [line, nodes] : placed)
      if (nodes.size() == 1 && !line->names.empty())
        mesh_.named_points.push_back(
            {nodes[0], {static_cast<int>(mesh_.named_points.size()) + 1, line->names}});
    editor_.finish();
    join_pieces();
    mark_corners(placed);
    model_.loose.clear();
    if (!model_.projector) return;
    std::vector<int> faces;
    for (const EmbeddedCurve& c : model_.embedded)
      if (c.curve >= first_curve_) faces.push_back(c.face);
    model_.projector = with_curves_on_faces(model_.projector, first_curve_, std::move(faces));
  }

 private:
  struct Placed {
    const LooseLine* line;
    std::vector<int> nodes;
  };
  struct Piece {
    const LooseLine* line;
    int face;
  };

  void refuse(const LooseLine& line, const std::string& what) {
    if (line.is_requested) throw InputError(line.where + " " + what);
    model_.warnings.push_back(
        {"lines of the file that are left out", 0, line.where + " is left out: it " + what});
  }

  /// The nodes of its points, without repetition for a line; none where it does not fit.
  std::optional<std::vector<int>> place(const LooseLine& line) {
    for (const Vec3& x : line.points) {
      const double distance = norm(true_place(places_.find(x, editor_)) - x);
      if (distance <= kFit * diagonal_) continue;
      refuse(line, fmt::format("is {:.4g} away from the surface at {}: expected at most {:.4g}, a thousandth "
                               "of the model's diagonal [off-the-surface]",
                               distance, show_point(x), kFit * diagonal_));
      return std::nullopt;
    }
    std::vector<int> nodes;
    for (const Vec3& x : line.points) {
      const int node = node_at(x);
      if (nodes.empty() || nodes.back() != node)
        nodes.push_back(node);
      else if (line.is_requested)
        throw InputError(
            fmt::format("{} has length zero at {}: expected different points", line.where, show_point(x)));
    }
    if (nodes.size() == 1 && line.points.size() > 1) {
      refuse(line, "has length zero: expected different points");
      return std::nullopt;
    }
    return nodes;
  }

  Vec3 true_place(const SplitTriangles::Found& found) const {
    return model_.projector ? model_.projector->to_face(mesh_.triangle_region[found.triangle], found.at)
                            : found.at;
  }

  int node_at(const Vec3& x) {
    const double snap = kSnap * diagonal_;
    const SplitTriangles::Found found = places_.find(x, editor_);
    const auto v = mesh_.triangles[found.triangle];
    for (const int p : v)
      if (std::min(norm(mesh_.points[p] - found.at), norm(mesh_.points[p] - x)) <= snap) return p;
    for (int k = 0; k < 3; ++k) {
      const int a = v[(k + 1) % 3], b = v[(k + 2) % 3];
      const Vec3 d = mesh_.points[b] - mesh_.points[a], to = found.at - mesh_.points[a];
      if (norm(cross(d, to)) <= snap * norm(d)) return split(a, b, found.at);
      // A point of a curve need not be one of its chord.
      const int line = editor_.line_on(a, b);
      if (line < 0 || !model_.projector || mesh_.line_curve[line] >= first_curve_) continue;
      const double part = dot(to, d) / dot(d, d);
      if (part > 0 && part < 1 && norm(model_.projector->to_curve(mesh_.line_curve[line], x) - x) <= snap)
        return split(a, b, mesh_.points[a] + part * d);
    }
    return editor_.split_triangle(found.triangle,
                                  on_surface(found.at, -1, mesh_.triangle_region[found.triangle],
                                             norm(mesh_.points[v[1]] - mesh_.points[v[0]])));
  }

  int split(int a, int b, const Vec3& x, const SectionPlane* plane = nullptr) {
    const int line = editor_.line_on(a, b);
    const int curve = line < 0 || mesh_.line_curve[line] >= first_curve_ ? -1 : mesh_.line_curve[line];
    const int face = mesh_.triangle_region[editor_.triangles_on(a, b).front()];
    return editor_.split_edge(a, b,
                              on_surface(x, curve, face, norm(mesh_.points[b] - mesh_.points[a]), plane));
  }

  /// On the true surface, where that is near, and in the plane.
  Vec3 on_surface(const Vec3& x, int curve, int face, double edge,
                  const SectionPlane* plane = nullptr) const {
    if (!model_.projector) return x;
    constexpr double kMaxMove = 0.1;
    constexpr int kSteps = 4;
    Vec3 y = x;
    for (int step = 0; step < kSteps; ++step) {
      if (plane != nullptr && curve < 0) y = y - plane->height(y) * plane->normal;
      y = curve >= 0 ? model_.projector->to_curve(curve, y) : model_.projector->to_face(face, y);
    }
    return norm(y - x) <= kMaxMove * edge ? y : x;
  }

  /// Points that were asked for lie well apart or at the same place.
  void check_apart(const std::vector<Placed>& placed) {
    std::vector<std::pair<int, const LooseLine*>> nodes;
    for (const auto& [line, of_line] : placed)
      if (line->is_requested)
        for (const int v : of_line) nodes.emplace_back(v, line);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 x = mesh_.points[nodes[i].first];
      const double apart = kApart * size_.at(x, hint_);
      for (std::size_t j = 0; j < i; ++j) {
        const double distance = norm(mesh_.points[nodes[j].first] - x);
        if (nodes[i].first == nodes[j].first || distance >= apart) continue;
        throw InputError(
            fmt::format("{} has a point at {} that is {:.3g} from one of {}: expected the same "
                        "place, or at least a thousandth of the size, {:.3g}",
                        nodes[i].second->where, show_point(x), distance, nodes[j].second->where, apart));
      }
    }
  }

  /// Becomes a chain of edges.
  void draw(const LooseLine& line, int a, int b) {
    const SectionPlane plane =
        section_plane(mesh_, a, b, normals_.at(mesh_.points[a]) + normals_.at(mesh_.points[b]));
    std::vector<int> chain;
    for (const auto& [v, w] : section_path(mesh_, editor_, plane, a, b, kSnap * diagonal_))
      chain.push_back(w < 0 ? v : split(v, w, position(mesh_, plane, {v, w}), &plane));
    if (chain.empty()) {
      refuse(line,
             fmt::format("leaves the surface between {} and {}: expected points between them on the way",
                         show_point(mesh_.points[a]), show_point(mesh_.points[b])));
      return;
    }
    double along = 0;
    int neighbour = -1;
    std::vector<int> run;
    int face = -1;
    const auto end_run = [&] {
      if (run.size() > 1) add_piece(line, run, face);
      run.clear();
    };
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const int p = chain[i], q = chain[i + 1];
      const int there = editor_.line_on(p, q);
      if (there >= 0) {
        end_run();
        along += norm(mesh_.points[q] - mesh_.points[p]);
        neighbour = mesh_.line_curve[there];
        continue;
      }
      const int here = mesh_.triangle_region[editor_.triangles_on(p, q).front()];
      if (here != face) end_run();
      face = here;
      if (run.empty()) run.push_back(p);
      run.push_back(q);
    }
    end_run();
    if (along > std::min(kFit * diagonal_, 0.5 * norm(mesh_.points[b] - mesh_.points[a])))
      refuse(line,
             fmt::format("runs along {} between {} and {}: expected it apart, or the name on that curve",
                         curve_name(neighbour), show_point(mesh_.points[a]), show_point(mesh_.points[b])));
  }

  std::string curve_name(int curve) const {
    const Entity& entity = mesh_.curves[curve];
    return fmt::format("curve {}{}", entity.tag,
                       entity.names.empty() ? "" : fmt::format(" '{}'", entity.names[0]));
  }

  /// With a point inside, so that a patch can be opened between its ends.
  void add_piece(const LooseLine& line, std::vector<int> chain, int face) {
    if (chain.size() == 2)
      chain.insert(chain.begin() + 1,
                   split(chain[0], chain[1], 0.5 * (mesh_.points[chain[0]] + mesh_.points[chain[1]])));
    mesh_.curves[editor_.add_curve(chain)].names = line.names;
    pieces_.push_back({&line, face});
  }

  /// A point of the file that has no room stays no node.
  void add_dangling_edges(std::vector<Placed>& placed) {
    std::vector<int> points;
    std::vector<const LooseLine*> lines;  // one for each, one that was asked for if there is any
    for (const auto& [line, nodes] : placed) {
      if (nodes.size() != 1 || editor_.is_on_line(nodes[0])) continue;
      const auto known = std::ranges::find(points, nodes[0]);
      if (known == points.end()) {
        points.push_back(nodes[0]);
        lines.push_back(line);
      } else if (line->is_requested) {
        lines[known - points.begin()] = line;
      }
    }
    if (points.empty()) return;
    DanglingEdges dangling(mesh_, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3 normal;
      for (const int t : editor_.triangles_at(points[i])) {
        const auto& [a, b, c] = mesh_.triangles[t];
        normal = normal + cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]);
      }
      const double size = size_.at(mesh_.points[points[i]], hint_);
      const auto ends =
          dangling.ends(i, normal, size, [&](const Vec3& x) { return places_.find(x, editor_).at; });
      if (!ends) {
        refuse(*lines[i], no_room_for_edges(size, show_point(mesh_.points[points[i]])));
        std::erase_if(placed,
                      [&](const Placed& p) { return p.nodes.size() == 1 && p.nodes[0] == points[i]; });
        continue;
      }
      for (const Vec3& end : *ends) draw(dangling_, points[i], node_at(end));
    }
  }

  /// Pieces of one line that follow each other in one face are one curve.
  void join_pieces() {
    if (pieces_.empty()) return;
    std::vector<int> first(pieces_.size(), -1), last(pieces_.size(), -1);
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l) {
      const int piece = mesh_.line_curve[l] - first_curve_;
      if (piece < 0) continue;
      if (first[piece] < 0) first[piece] = mesh_.lines[l][0];
      last[piece] = mesh_.lines[l][1];
    }
    std::vector<int> renamed;
    std::vector<Entity> curves(mesh_.curves.begin(), mesh_.curves.begin() + first_curve_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const bool goes_on = i > 0 && pieces_[i].line == pieces_[i - 1].line &&
                           pieces_[i].face == pieces_[i - 1].face && first[i] == last[i - 1];
      if (!goes_on) {
        Entity entity = mesh_.curves[first_curve_ + static_cast<int>(i)];
        entity.tag = mesh_.curves[first_curve_].tag + static_cast<int>(curves.size()) - first_curve_;
        model_.embedded.push_back({static_cast<int>(curves.size()), pieces_[i].face,
                                   pieces_[i].line == &dangling_, pieces_[i].line->is_crack});
        curves.push_back(std::move(entity));
      }
      renamed.push_back(static_cast<int>(curves.size()) - 1);
    }
    for (int& curve : mesh_.line_curve)
      if (curve >= first_curve_) curve = renamed[curve - first_curve_];
    mesh_.curves = std::move(curves);
  }

  /// Where new curves end, turn sharply or meet others, and the points that were asked for.
  void mark_corners(const std::vector<Placed>& placed) {
    std::map<int, std::vector<int>> at;  // lines at the nodes of new curves
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      if (mesh_.line_curve[l] >= first_curve_)
        for (const int v : mesh_.lines[l]) at[v];
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      for (const int v : mesh_.lines[l])
        if (const auto here = at.find(v); here != at.end()) here->second.push_back(static_cast<int>(l));
    const auto far = [&](int line, int v) {
      return mesh_.points[mesh_.lines[line][0] == v ? mesh_.lines[line][1] : mesh_.lines[line][0]];
    };
    for (const auto& [v, lines] : at)
      if (lines.size() != 2 || mesh_.line_curve[lines[0]] != mesh_.line_curve[lines[1]] ||
          turn_angle(far(lines[0], v), mesh_.points[v], far(lines[1], v)) > kSharpTurn)
        model_.corners.push_back(v);
    for (const auto& [line, nodes] : placed)
      if (line->is_requested || nodes.size() == 1)
        model_.corners.insert(model_.corners.end(), nodes.begin(), nodes.end());
    sort_unique(model_.corners);
  }

  SurfaceModel& model_;
  Mesh& mesh_;
  const SizeField& size_;
  mutable int hint_ = -1;
  double diagonal_;
  int first_curve_;
  SurfaceEditor editor_;
  SplitTriangles places_;
  SmoothNormals normals_;
  std::vector<Piece> pieces_;
  const LooseLine dangling_{{}, {}, "the edge at a single point", true};
};

}  // namespace

void imprint(SurfaceModel& model, const SizeField& size) {
  if (!model.loose.empty()) Imprinter(model, size).run();
}

std::shared_ptr<const SizeField> imprint_named(const std::vector<NamedSize>& named,
                                               std::shared_ptr<const SizeField> size, SurfaceModel& model,
                                               std::vector<Warning>& warnings) {
  if (named.empty()) {
    imprint(model, *size);
    return size;
  }
  // Parts of the triangles before they are split give the same sizes to the last bit, whatever is imprinted.
  NamedParts parts(model.fine);
  const std::size_t n_curves = model.fine.curves.size(), n_points = model.fine.named_points.size();
  // Edges at single points follow their sizes, before the lines have their places on the surface.
  std::vector<LocalSize> spots = parts.known_spots(named);
  const std::vector<LocalSize> loose = NamedParts(model.loose).known_spots(named);
  spots.insert(spots.end(), loose.begin(), loose.end());
  imprint(model, *finer_near(size, std::move(spots)));
  parts.add_lines(model.fine, n_curves, n_points);
  warn_of_ineffective_sizes(named, parts, *size, warnings);
  return finer_near(size, parts.spots(named));
}

}  // namespace delquad
