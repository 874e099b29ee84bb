#include "geometry/planar/mapped_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "matching/side_counts.h"

namespace delquad {
namespace {

/// What kAuto takes: angles of corners and of other nodes may be so far from 90 and 180 degrees, and wanted
/// numbers of edges of opposite sides have at most this ratio.
constexpr double kCornerSlack = 35, kStraightSlack = 30, kMostSideRatio = 2.05;

/// A piece on a face's outline.
struct OutlinePiece {
  int piece;
  bool forward;
  double angle;  ///< inside, where it begins; radians
};

class FaceOutlines {
 public:
  FaceOutlines(const Mesh& lines, const Arrangement& arrangement, const std::vector<CurvePiece>& pieces)
      : lines_(lines), arrangement_(arrangement), pieces_(pieces) {
    for (std::size_t i = 0; i < pieces.size(); ++i)
      for (int k = 0; k < pieces[i].n; ++k) piece_of_.push_back(static_cast<int>(i));
  }

  /// The outline of a face, from a node between pieces on; empty where there is none, or a hole.
  std::vector<OutlinePiece> of(int face) const {
    if (arrangement_.faces[face].cycles.size() != 1) return {};
    const Arrangement::Cycle& cycle = arrangement_.faces[face].cycles[0];
    std::vector<OutlinePiece> outline;
    for (const int side : cycle) {
      const int piece = piece_of_[side / 2];
      const bool forward = side % 2 == 0;
      const int begin = pieces_[piece].ends[forward ? 0 : 1];
      if (start_of(lines_.lines, side) != begin) continue;  // goes on
      outline.push_back({piece, forward, 0});
    }
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const OutlinePiece& before = outline[(k + outline.size() - 1) % outline.size()];
      outline[k].angle = angle_between(before, outline[k]);
    }
    return outline;
  }

  int node(const OutlinePiece& p) const { return pieces_[p.piece].ends[p.forward ? 0 : 1]; }

 private:
  /// From an end of a piece a little way along it.
  Vec2 leaving(int piece, bool from_start) const {
    const CurvePiece& p = pieces_[piece];
    const double step = 1e-3 * (p.to - p.from);
    return from_start ? p.shape->point(p.from + step) - p.shape->point(p.from)
                      : p.shape->point(p.to - step) - p.shape->point(p.to);
  }
  double angle_between(const OutlinePiece& before, const OutlinePiece& after) const {
    const Vec2 out = leaving(after.piece, after.forward), back = leaving(before.piece, !before.forward);
    const double angle = std::atan2(cross(out, back), dot(out, back));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }

  const Mesh& lines_;
  const Arrangement& arrangement_;
  const std::vector<CurvePiece>& pieces_;
  std::vector<int> piece_of_;  ///< of each line
};

double degrees(double angle) { return angle * 180 / std::numbers::pi; }

/// Places in the outline of the four corners, ascending.
std::array<std::size_t, 4> four_corners(const std::vector<OutlinePiece>& outline) {
  std::vector<std::size_t> order(outline.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  // What the angle is nearer to a right one than to a straight one.
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) {
    return std::abs(degrees(outline[i].angle) - 180) - std::abs(degrees(outline[i].angle) - 90);
  });
  std::array<std::size_t, 4> corners{order[0], order[1], order[2], order[3]};
  std::ranges::sort(corners);
  return corners;
}

MappedFace mapped_by_outline(int face, const std::vector<OutlinePiece>& outline,
                             const FaceOutlines& outlines) {
  const auto corners = four_corners(outline);
  MappedFace mapped{face, true, {}, {}};
  for (int k = 0; k < 4; ++k) {
    mapped.corners[k] = outlines.node(outline[corners[k]]);
    for (std::size_t i = corners[k]; i != corners[(k + 1) % 4]; i = (i + 1) % outline.size())
      mapped.sides[k].push_back(outline[i].piece);
  }
  return mapped;
}

/// Whether a grid pays there.
bool looks_mapped(const std::vector<OutlinePiece>& outline, const MappedFace& mapped,
                  const std::vector<CurvePiece>& pieces) {
  const auto corners = four_corners(outline);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const bool is_corner = std::ranges::find(corners, i) != corners.end();
    if (std::abs(degrees(outline[i].angle) - (is_corner ? 90 : 180)) >
        (is_corner ? kCornerSlack : kStraightSlack))
      return false;
  }
  for (const int k : {0, 1}) {
    double want[2] = {0, 0};
    for (const int opposite : {0, 1})
      for (const int piece : mapped.sides[k + 2 * opposite])
        want[opposite] += pieces[piece].measure->integral();
    if (std::max(want[0], want[1]) > kMostSideRatio * std::min(want[0], want[1])) return false;
  }
  return true;
}

std::string region_label(const Entity& region) {
  return region.names.empty() ? fmt::format("region_{}", region.tag) : region.names[0];
}

bool is_named(const MappedSpec& spec, const Entity& region) {
  return std::ranges::any_of(spec.names, [&](const std::string& name) {
    return name == fmt::format("region_{}", region.tag) ||
           std::ranges::find(region.names, name) != region.names.end();
  });
}

void check_names(const MappedSpec& spec, const FaceRegions& regions) {
  for (const std::string& name : spec.names) {
    std::vector<std::string> known;
    bool found = false;
    for (const Entity& region : regions.regions) {
      known.push_back(region_label(region));
      found |= is_named({{name}, false, {}}, region);
    }
    if (!found)
      throw InputError(
          fmt::format("{}: no region is called '{}'{}", spec.where, name, suggestion(name, known)));
  }
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

std::vector<MappedFace> find_mapped_faces(const MappedSpec& spec, const Mesh& lines,
                                          const Arrangement& arrangement, const FaceRegions& regions,
                                          const std::vector<CurvePiece>& pieces) {
  check_names(spec, regions);
  const FaceOutlines outlines(lines, arrangement, pieces);
  std::vector<MappedFace> mapped;
  for (std::size_t f = 0; f < regions.region.size(); ++f) {
    if (regions.region[f] < 0) continue;
    const Entity& region = regions.regions[regions.region[f]];
    const bool asked = is_named(spec, region);
    if (!asked && !spec.automatic) continue;
    const std::vector<OutlinePiece> outline = outlines.of(static_cast<int>(f));
    if (outline.size() < 4) {
      if (!asked) continue;
      throw InputError(fmt::format(
          "{}: '{}' cannot be a grid: {}", spec.where, region_label(region),
          outline.empty()
              ? "something lies inside of it: expected one outline"
              : fmt::format("its outline has {} corner(s): expected at least 4", outline.size())));
    }
    MappedFace face = mapped_by_outline(static_cast<int>(f), outline, outlines);
    face.is_asked = asked;
    std::set<int> nodes(face.corners.begin(), face.corners.end());
    if (!asked && (nodes.size() < 4 || !looks_mapped(outline, face, pieces))) continue;
    mapped.push_back(std::move(face));
  }
  return mapped;
}

void balance_mapped(const PlanarModel& model, std::span<const MappedFace> mapped,
                    const Arrangement& arrangement, const FaceRegions& regions,
                    std::vector<CurvePiece>& pieces) {
  const auto leader = [&](int i) { return pieces[i].master < 0 ? i : pieces[i].master; };
  std::vector<CountedCurve> curves;
  for (const CurvePiece& p : pieces)
    curves.push_back(
        {p.measure ? p.measure->integral() : 1, p.n, p.least, !p.is_divided && p.master < 0 && p.curve >= 0});
  std::vector<CountedFace> faces(arrangement.faces.size());
  for (const MappedFace& m : mapped) {
    faces[m.face].is_mapped = true;
    for (int k = 0; k < 4; ++k)
      for (const int piece : m.sides[k]) faces[m.face].sides[k].push_back(leader(piece));
  }
  std::size_t line = 0;
  for (std::size_t i = 0; i < pieces.size(); line += static_cast<std::size_t>(pieces[i++].n))
    for (const int side : {0, 1}) {
      const int f = arrangement.face_of[2 * line + side];
      if (f >= 0 && regions.region[f] >= 0 && !faces[f].is_mapped)
        faces[f].sides[0].push_back(leader(static_cast<int>(i)));
    }
  if (const auto bad = balance_counts(curves, faces)) {
    const std::string name = region_label(regions.regions[regions.region[*bad]]);
    if (faces[*bad].is_mapped && leaves_something_out(*bad, arrangement, regions, pieces))
      throw InputError(
          fmt::format("{}'{}' cannot be a grid: something lies inside of it: expected one outline",
                      message_prefix(model), name));
    throw InputError(fmt::format(
        "{}the numbers of edges that are given leave '{}' {}: change or leave out that of one of its curves",
        message_prefix(model), name,
        faces[*bad].is_mapped
            ? "with sides that do not match, and a grid needs equal numbers on opposite sides"
            : "with an odd number around it, and quads need an even one"));
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (curves[i].n != pieces[i].n && pieces[i].master < 0) pieces[i].set_edges(curves[i].n);
}

}  // namespace delquad
