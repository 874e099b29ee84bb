#include "features/grids/grids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "base/segment.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {
namespace {

class FaceOutlines {
 public:
  FaceOutlines(const Mesh& lines, const Arrangement& arrangement, const std::vector<CurvePiece>& pieces)
      : lines_(lines), arrangement_(arrangement), pieces_(pieces) {
    for (std::size_t i = 0; i < pieces.size(); ++i)
      for (int k = 0; k < pieces[i].n; ++k) piece_of_.push_back(static_cast<int>(i));
  }

  /// The loops of a face, each from a node between pieces on.
  FaceOutline of(int face) const {
    FaceOutline outline;
    for (const Arrangement::Cycle& cycle : arrangement_.faces[face].cycles) {
      auto& loop = outline.emplace_back();
      std::vector<char> forward;
      for (const int side : cycle) {
        const int piece = piece_of_[side / 2];
        const bool is_forward = side % 2 == 0;
        const CurvePiece& p = pieces_[piece];
        const int begin = p.ends[is_forward ? 0 : 1];
        if (start_of(lines_.lines, side) != begin) continue;  // goes on
        const double want = p.is_divided || !p.measure ? p.n : p.measure->integral();
        loop.push_back({piece, begin, lines_.points[begin], 0, want});
        forward.push_back(is_forward);
      }
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::size_t before = (k + loop.size() - 1) % loop.size();
        loop[k].angle = angle_between(leaving(loop[k].curve, forward[k] != 0),
                                      leaving(loop[before].curve, forward[before] == 0));
      }
    }
    return outline;
  }

  /// Its area in squares of its edges.
  double quads_of(int face, const FaceOutline& outline) const {
    double area = 0, length = 0, want = 0;
    for (const Arrangement::Cycle& cycle : arrangement_.faces[face].cycles)
      for (const int side : cycle) {
        const Vec3 a = lines_.points[start_of(lines_.lines, side)];
        const Vec3 b = lines_.points[start_of(lines_.lines, side ^ 1)];
        area += cross(Vec2{a.x, a.y}, Vec2{b.x, b.y}) / 2;
        length += norm(b - a);
      }
    for (const auto& loop : outline)
      for (const OutlinePart& part : loop) want += part.want;
    return area * want / length * want / length;
  }

  /// Of a ring: whether with some number of rows its edges across are neither too short nor too long.
  bool has_rows(int face, const FaceOutline& outline) const {
    const std::vector<Arrangement::Cycle>& cycles = arrangement_.faces[face].cycles;
    const auto end = [&](int side) {
      const Vec3& x = lines_.points[start_of(lines_.lines, side)];
      return Vec2{x.x, x.y};
    };
    double length = 0, want = 0, narrowest = std::numeric_limits<double>::infinity(), widest = 0;
    for (const OutlinePart& part : outline[0]) want += part.want;
    for (const int side : cycles[0]) {
      length += norm(end(side ^ 1) - end(side));
      double width = std::numeric_limits<double>::infinity();
      for (const int other : cycles[1])
        width = std::min(width, distance_to_segment(end(side), end(other), end(other ^ 1)));
      narrowest = std::min(narrowest, width);
      widest = std::max(widest, width);
    }
    const double edge = length / want;
    return widest <= kAskedLong * edge * std::max(1.0, std::floor(narrowest / (kAskedShort * edge)));
  }

 private:
  /// From an end of a piece a little way along it.
  Vec2 leaving(int piece, bool from_start) const {
    const CurvePiece& p = pieces_[piece];
    const double step = 1e-3 * (p.to - p.from);
    return from_start ? p.shape->point(p.from + step) - p.shape->point(p.from)
                      : p.shape->point(p.to - step) - p.shape->point(p.to);
  }
  static double angle_between(Vec2 out, Vec2 back) {
    const double angle = std::atan2(cross(out, back), dot(out, back));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }

  const Mesh& lines_;
  const Arrangement& arrangement_;
  const std::vector<CurvePiece>& pieces_;
  std::vector<int> piece_of_;  ///< of each line
};

std::string piece_label(const PlanarModel& model, const CurvePiece& piece) {
  if (piece.curves.empty()) return "the edge at a point";
  const std::string& name = model.curves[piece.curves[0]].name;
  return name.empty() ? fmt::format("curve_{}", piece.curves[0] + 1) : name;
}

/// Where on a patch's outline parts with these numbers of edges begin, the first of them at `nodes`; -1: it
/// is another patch.
int outline_begin(const std::vector<Vec2>& nodes, const std::vector<int>& counts, const PatchBoundary& patch,
                  const std::vector<Vec3>& points) {
  const int n = std::accumulate(counts.begin(), counts.end(), 0);
  // Points moved apart along a cut are told by the nodes that they stand for.
  const auto is_at = [&](int i, Vec2 x) {
    const Vec3& node = points[patch.point_node[i % n]];
    return node.x == x.x && node.y == x.y;
  };
  for (int first = 0; first < n; ++first) {
    int at = first;
    bool fits = true;
    for (std::size_t k = 0; fits && k < counts.size(); at += counts[k++]) fits = is_at(at, nodes[k]);
    if (fits) return first;
  }
  return -1;
}

/// Whether the faces of a region that hang together with this one leave something out inside: more than one
/// loop bounds them. Axes of symmetry make faces with one outline each of such a region.
bool leaves_something_out(int face, const Arrangement& arrangement, const FaceRegions& regions,
                          const std::vector<CurvePiece>& pieces) {
  std::vector<int> piece_of;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    piece_of.insert(piece_of.end(), static_cast<std::size_t>(pieces[i].n), static_cast<int>(i));
  std::vector<int> together{face};
  std::set<int> seen{face}, border;
  for (std::size_t i = 0; i < together.size(); ++i)
    for (const auto& cycle : arrangement.faces[together[i]].cycles)
      for (const int side : cycle) {
        const int other = arrangement.face_of[side ^ 1];
        if (other < 0 || regions.region[other] != regions.region[face])
          border.insert(piece_of[side / 2]);
        else if (seen.insert(other).second)
          together.push_back(other);
      }
  int loops = 0;
  while (!border.empty()) {
    ++loops;
    std::set<int> nodes(pieces[*border.begin()].ends.begin(), pieces[*border.begin()].ends.end());
    for (bool grows = true; grows;) {
      const std::size_t before = border.size();
      std::erase_if(border, [&](int p) {
        if (!nodes.contains(pieces[p].ends[0]) && !nodes.contains(pieces[p].ends[1])) return false;
        nodes.insert(pieces[p].ends.begin(), pieces[p].ends.end());
        return true;
      });
      grows = border.size() < before;
    }
  }
  return loops > 1;
}

}  // namespace

std::vector<MappedPlanarFace> find_mapped_faces(const PlanarModel& model, const MappedSpec& spec,
                                                const Mesh& lines, const Arrangement& arrangement,
                                                const FaceRegions& regions, const ModelChain& chain,
                                                const std::vector<CurvePiece>& pieces) {
  GridFinder::NamedPlaces points;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Vec2 at = chain.nodes[chain.point_nodes[i]];
    points.emplace_back(model.points[i].name, Vec3{at.x, at.y, 0});
  }
  GridFinder finder(spec, regions.regions, points);
  const FaceOutlines outlines(lines, arrangement, pieces);
  std::vector<MappedPlanarFace> mapped;
  for (std::size_t f = 0; f < regions.region.size(); ++f) {
    if (regions.region[f] < 0) continue;
    const FaceOutline outline = outlines.of(static_cast<int>(f));
    const auto found = finder.find(static_cast<int>(f), regions.regions[regions.region[f]], outline,
                                   outlines.quads_of(static_cast<int>(f), outline));
    if (!found) continue;
    const bool is_just_narrow = !found->is_asked && !spec.automatic, is_ring = found->begins.empty();
    if (is_just_narrow && is_ring && !outlines.has_rows(static_cast<int>(f), outline)) continue;
    auto& face = mapped.emplace_back(MappedPlanarFace{*found, {}});
    for (const auto& loop : outline)
      for (const OutlinePart& part : loop) face.nodes.push_back({part.at.x, part.at.y});
  }
  finder.finish();
  return mapped;
}

namespace {

constexpr double kMostEdges = 1e8;

/// Edges that the size asks for around the faces.
void want_by(const PointSize& size, const std::vector<MappedPlanarFace>& mapped,
             const std::vector<CurvePiece>& pieces, const std::vector<int>& leader,
             const std::vector<std::string>& names, std::vector<CountedCurve>& curves) {
  for (const MappedPlanarFace& face : mapped)
    for (const auto& side : face.sides)
      for (const int i : side) {
        const CurvePiece& p = pieces[leader[i]];
        if (p.measure)
          curves[leader[i]].want =
              ArcMeasure(*p.shape, p.from, p.to, size, names[leader[i]], kMostEdges).integral();
      }
}

}  // namespace

void balance_mapped(const PlanarModel& model, std::vector<MappedPlanarFace>& mapped,
                    const Arrangement& arrangement, const FaceRegions& regions, const PointSize& grid_size,
                    std::vector<CurvePiece>& pieces) {
  std::vector<CountedCurve> curves;
  std::vector<int> leader;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const CurvePiece& p = pieces[i];
    curves.push_back(
        {p.measure ? p.measure->integral() : 1, p.n, p.least, !p.is_divided && p.master < 0 && p.curve >= 0});
    leader.push_back(p.master < 0 ? static_cast<int>(i) : p.master);
    names.push_back(piece_label(model, p));
  }
  if (grid_size) want_by(grid_size, mapped, pieces, leader, names, curves);
  std::vector<std::vector<int>> around(arrangement.faces.size());
  std::size_t line = 0;
  for (std::size_t i = 0; i < pieces.size(); line += static_cast<std::size_t>(pieces[i++].n))
    for (const int side : {0, 1}) {
      const int f = arrangement.face_of[2 * line + side];
      if (f >= 0 && regions.region[f] >= 0) around[f].push_back(leader[i]);
    }
  std::vector<MappedFace> faces(mapped.begin(), mapped.end());
  const auto bad = balance_grids(curves, around, leader, faces);
  std::erase_if(mapped, [&](const MappedFace& m) {
    return std::ranges::find(faces, m.face, &MappedFace::face) == faces.end();
  });
  if (mapped.empty()) return;
  if (!bad.empty()) {
    const auto face = std::ranges::find(faces, bad[0].face, &MappedFace::face);
    if (face != faces.end() && leaves_something_out(face->face, arrangement, regions, pieces))
      throw InputError(
          fmt::format("{}'{}' cannot be a grid: something lies inside of it: expected one outline",
                      message_prefix(model), region_label(regions.regions[regions.region[bad[0].face]])));
    throw InputError(message_prefix(model) +
                     why_unbalanced(bad[0], region_label(regions.regions[regions.region[bad[0].face]]),
                                    face == faces.end() ? nullptr : &*face, curves, names));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (curves[i].n != pieces[i].n && pieces[i].master < 0) pieces[i].set_edges(curves[i].n);
}

std::vector<MappedPatch> mapped_patches(const std::vector<MappedPlanarFace>& mapped,
                                        const std::vector<CurvePiece>& pieces,
                                        const std::vector<PatchBoundary>& patches,
                                        const std::vector<Vec3>& points) {
  std::vector<MappedPatch> found;
  for (const MappedPlanarFace& face : mapped) {
    std::vector<int> counts;  // of the parts of its outline, from that on at which the first side begins
    for (const auto& side : face.sides)
      for (const int piece : side) counts.push_back(pieces[piece].n);
    const int n_edges = std::accumulate(counts.begin(), counts.end(), 0);
    std::vector<Vec2> nodes = face.nodes;
    if (face.begins.empty())
      counts.resize(face.sides[0].size());
    else
      std::ranges::rotate(nodes, nodes.begin() + static_cast<long>(face.begins[0]));
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const int n = static_cast<int>(patches[p].points.size());
      if (n != n_edges) continue;
      const int first = outline_begin(nodes, counts, patches[p], points);
      if (first < 0) continue;
      MappedPatch& patch = found.emplace_back(MappedPatch{static_cast<int>(p), {}, face.is_asked});
      int at = first;
      for (const auto& side : face.sides) {
        if (face.begins.empty()) break;
        patch.corners.push_back(at % n);
        for (const int piece : side) at += pieces[piece].n;
      }
      break;
    }
  }
  return found;
}

}  // namespace delquad
