// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/domain_brep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "delquad/domain.h"
#include "experiments/sweep/peer.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Bezier curves of the third degree, one after the other, as one B-spline.
class CubicChain {
 public:
  CubicChain(const DomainCurve& piece, double tolerance)
      : piece_(piece), tolerance_(tolerance), poles_{piece.shape->point(piece.from)} {
    add(0, 1, 0);
  }

  /// As in BREP files.
  std::string text() const {
    std::string text = fmt::format("7 0 0 3 {} {}", poles_.size(), knots_.size());
    for (const Vec2 p : poles_) text += fmt::format(" {} {} 0", p.x, p.y);
    for (std::size_t i = 0; i < knots_.size(); ++i)
      text += fmt::format(" {} {}", knots_[i], i == 0 || i + 1 == knots_.size() ? 4 : 3);
    return text;
  }

 private:
  Vec2 at(double s) const { return piece_.shape->point(std::lerp(piece_.from, piece_.to, s)); }

  void add(double begin, double end, int halvings) {
    constexpr int kFewest = 2, kMost = 12;
    const auto here = [&](double s) { return at(std::lerp(begin, end, s)); };
    const Vec2 q[4] = {here(0), here(1. / 3), here(2. / 3), here(1)};
    const Vec2 b = (1. / 6) * (18 * q[1] - 9 * q[2] + 2 * q[3] - 5 * q[0]);
    const Vec2 c = (1. / 6) * (18 * q[2] - 9 * q[1] + 2 * q[0] - 5 * q[3]);
    const auto off = [&](double s) {
      const double r = 1 - s;
      return norm(r * r * r * q[0] + 3 * r * r * s * b + 3 * r * s * s * c + s * s * s * q[3] - here(s));
    };
    const bool fits = std::max({off(1. / 6), off(1. / 2), off(5. / 6)}) <= tolerance_;
    if (halvings < kFewest || (!fits && halvings < kMost)) {
      const double middle = (begin + end) / 2;
      add(begin, middle, halvings + 1);
      return add(middle, end, halvings + 1);
    }
    poles_.insert(poles_.end(), {b, c, q[3]});
    knots_.push_back(end);
  }

  const DomainCurve& piece_;
  double tolerance_;
  std::vector<Vec2> poles_;
  std::vector<double> knots_ = {0};
};

/// A curve as in BREP files, and the parameter at its end; at its start that is 0.
std::pair<std::string, double> curve_text(const DomainCurve& piece) {
  constexpr int kSamples = 24;
  constexpr double kSame = 1e-12, kClose = 1e-9;  // of the piece's extent
  std::vector<Vec2> p;
  for (int i = 0; i <= kSamples; ++i)
    p.push_back(piece.shape->point(std::lerp(piece.from, piece.to, double(i) / kSamples)));
  const double extent = diagonal(p);
  const Vec2 along = p.back() - p[0];
  const auto is_on_line = [&](Vec2 x) { return std::abs(cross(x - p[0], along)) <= kSame * extent * extent; };
  if (norm(along) > 0 && std::ranges::all_of(p, is_on_line)) {
    const Vec2 unit = (1 / norm(along)) * along;
    return {fmt::format("1 {} {} 0 {} {} 0", p[0].x, p[0].y, unit.x, unit.y), norm(along)};
  }
  const Vec2 a = p[kSamples / 3] - p[0], b = p[2 * kSamples / 3] - p[0];
  const double twice = 2 * cross(a, b);
  const Vec2 centre =
      p[0] + (1 / twice) * Vec2{b.y * dot(a, a) - a.y * dot(b, b), a.x * dot(b, b) - b.x * dot(a, a)};
  const double radius = norm(p[0] - centre);
  double angle = 0;
  for (int i = 0; i < kSamples; ++i)
    angle += std::atan2(cross(p[i] - centre, p[i + 1] - centre), dot(p[i] - centre, p[i + 1] - centre));
  const bool is_arc =
      std::ranges::all_of(p, [&](Vec2 x) { return std::abs(norm(x - centre) - radius) <= kSame * extent; });
  if (is_arc) {
    const Vec2 x = (1 / radius) * (p[0] - centre), y = angle > 0 ? Vec2{-x.y, x.x} : Vec2{x.y, -x.x};
    return {fmt::format("2 {} {} 0 0 0 {} {} {} 0 {} {} 0 {}", centre.x, centre.y, angle > 0 ? 1 : -1, x.x,
                        x.y, y.x, y.y, radius),
            std::abs(angle)};
  }
  return {CubicChain(piece, kClose * extent).text(), 1};
}

/// A part of a shape: its index, with its orientation: + or -, i inside.
struct Part {
  char orientation;
  std::size_t shape;
};

/// The edges of a patch as loops of points, the outermost first.
std::vector<std::vector<int>> loops_of(const PatchBoundary& boundary) {
  std::vector<int> next(boundary.points.size(), -1);
  for (const auto& [a, b] : boundary.edges) next[a] = b;
  std::vector<std::pair<double, std::vector<int>>> loops;  // twice the area
  for (int first = 0; first < static_cast<int>(next.size()); ++first) {
    double area = 0;
    std::vector<int> loop;
    for (int at = first; next[at] >= 0;) {
      loop.push_back(at);
      const int to = std::exchange(next[at], -1);
      area += cross(boundary.points[at], boundary.points[to]);
      at = to;
    }
    if (!loop.empty()) loops.emplace_back(area, std::move(loop));
  }
  std::ranges::stable_sort(loops, std::greater(), [](const auto& loop) { return loop.first; });
  std::vector<std::vector<int>> result;
  for (auto& [area, loop] : loops) result.push_back(std::move(loop));
  return result;
}

class DomainBrep {
 public:
  explicit DomainBrep(const Prepared& prepared)
      : boundary_(boundary_of(prepared)), pieces_(domain_curves(prepared)) {
    name_pieces();
    std::vector<Part> faces;
    for (std::size_t i = 0; i < prepared.n_patches(); ++i)
      faces.push_back({'+', add_face(prepared.patch(i))});
    add("Co\n\n1100000\n", std::move(faces));
  }

  void write(TextWriter& out) const {
    out << "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 0\nCurve2ds 0\n"
        << "Curves " << curves_.size() << "\n";
    for (const std::string& curve : curves_) out << curve << "\n";
    out << "Polygon3D 0\nPolygonOnTriangulations 0\nSurfaces 1\n1 0 0 0 0 0 1 1 0 0 0 1 0\n"
        << "Triangulations 0\n\nTShapes " << shapes_.size() << "\n";
    for (const auto& [head, parts] : shapes_) {
      out << head;
      for (const auto& [orientation, shape] : parts) out << orientation << shapes_.size() - shape << " 0 ";
      out << "*\n";
    }
    out << "\n+1 0\n";
  }

 private:
  struct Shape {
    std::string head;
    std::vector<Part> parts;
  };

  std::size_t add(std::string head, std::vector<Part> parts = {}) {
    shapes_.push_back({std::move(head), std::move(parts)});
    return shapes_.size() - 1;
  }

  /// The first edge along each piece tells which piece it is, and in which direction. Lines that are on no
  /// piece are straight ones.
  void name_pieces() {
    std::set<std::pair<int, int>> on_pieces;
    const auto name = [&](std::size_t piece) {
      const std::vector<int>& nodes = pieces_[piece].nodes;
      begins_[{nodes[0], nodes[1]}] = {'+', piece};
      begins_[{nodes.back(), nodes[nodes.size() - 2]}] = {'-', piece};
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        on_pieces.insert(std::minmax(nodes[i], nodes[i + 1]));
    };
    for (std::size_t i = 0; i < pieces_.size(); ++i) name(i);
    for (const auto& [a, b] : boundary_.lines) {
      if (on_pieces.contains(std::minmax(a, b))) continue;
      const Vec3 &p = boundary_.points[a], &q = boundary_.points[b];
      pieces_.push_back({make_segment({p.x, p.y}, {q.x, q.y}), 0, 1, {a, b}});
      name(pieces_.size() - 1);
    }
  }

  std::size_t vertex(int node) {
    const auto [at, is_new] = vertices_.try_emplace(node);
    const Vec3& p = boundary_.points[node];
    if (is_new) at->second = add(fmt::format("Ve\n{}\n{} {} 0\n0 0\n\n0101101\n", tolerance_, p.x, p.y));
    return at->second;
  }

  std::size_t edge(std::size_t piece) {
    const auto [at, is_new] = edges_.try_emplace(piece);
    if (!is_new) return at->second;
    const std::vector<int>& nodes = pieces_[piece].nodes;
    const Part begin{'+', vertex(nodes[0])}, end{'-', vertex(nodes.back())};
    const auto [text, length] = curve_text(pieces_[piece]);
    curves_.push_back(text);
    return at->second = add(
               fmt::format("Ed\n {} 1 1 0\n1 {} 0 0 {}\n0\n\n0101000\n", tolerance_, curves_.size(), length),
               {begin, end});
  }

  /// Curves with the patch on both sides, and points that are on no curve, stand inside of the face.
  std::size_t add_face(const PatchBoundary& patch) {
    std::vector<std::vector<Part>> wires;
    std::map<std::size_t, int> uses;
    for (const std::vector<int>& loop : loops_of(patch)) {
      std::vector<Part>& wire = wires.emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const auto at =
            begins_.find({patch.point_node[loop[k]], patch.point_node[loop[(k + 1) % loop.size()]]});
        if (at == begins_.end()) continue;
        wire.push_back({at->second.orientation, edge(at->second.shape)});
        ++uses[wire.back().shape];
      }
    }
    std::vector<Part> parts;
    const auto add_wire = [&](std::vector<Part> wire) {
      parts.push_back({'+', add("Wi\n\n0101100\n", std::move(wire))});
    };
    for (std::vector<Part>& wire : wires) {
      std::erase_if(wire, [&](const Part& part) { return uses.at(part.shape) > 1; });
      if (!wire.empty()) add_wire(std::move(wire));
    }
    for (const auto& [shape, count] : uses)
      if (count > 1) add_wire({{'i', shape}});
    for (const NamedPoint& named : boundary_.named_points)
      if (std::ranges::find(patch.point_node, named.point) != patch.point_node.end() &&
          !vertices_.contains(named.point))
        parts.push_back({'i', vertex(named.point)});
    return add(fmt::format("Fa\n0 {} 1 0\n\n0101000\n", tolerance_), std::move(parts));
  }

  const Mesh boundary_;
  std::vector<DomainCurve> pieces_;
  const double tolerance_ = 1e-7 * std::max(1.0, diagonal(boundary_));
  std::map<std::array<int, 2>, Part> begins_;  ///< by two nodes
  std::map<int, std::size_t> vertices_;        ///< by node
  std::map<std::size_t, std::size_t> edges_;   ///< by piece
  std::vector<std::string> curves_;
  std::vector<Shape> shapes_;
};

}  // namespace

void write_domain_brep(const std::filesystem::path& file, const Prepared& prepared) {
  write_text_file(file, [brep = DomainBrep(prepared)](TextWriter& out) { brep.write(out); });
}

}  // namespace delquad
