// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/midsurface/joined_plates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "base/segment.h"
#include "delquad/error.h"
#include "features/midsurface/planes.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {
namespace {

/// Distance in diagonals within which points are one, lie on a line or in a plane.
constexpr double kNear = 1e-6;
/// Least width of opposite faces over their distance: bends, and flat ones.
constexpr double kWide[] = {0.5, 1};
/// Faces that face each other in a smaller part of their area are not opposite: curved and flat ones.
constexpr double kFacing[] = {0.5, 0.1};
/// How much the thickness of a flat plate may differ.
constexpr double kSteady = 0.01;
/// Most width of a rim or weld, and most distance to the end of the body there, in thicknesses.
constexpr double kNarrow = 3;

/// Least distance from a face to the end of the body at a rounded rim, in thicknesses.
constexpr double kRounded = 0.05;
/// How much the distance to the other side may differ from the thickness, and an outline that joins others
/// from theirs.
constexpr double kAlike = 0.1;
/// Distance of points from a chord of a curved joint, over its length.
constexpr double kBent = 0.06;

/// How much the volume of all plates may differ from the volume of the body.
constexpr double kOther = 0.15;

struct PlateFace {
  bool is_flat = true;
  Vec3 at, inwards;  ///< a point, and the normal of a flat face
  double area = 0, width = 0, thickness = 0;
  double least = std::numeric_limits<double>::infinity(), most = 0;  ///< of the thickness
  std::set<int> opposite;                                            ///< faces
  int plate = -1, side = 0;                                          ///< -1: a rim, weld or fillet
  bool is_chosen = false;
};

/// A piece of the outline of a chosen face, in its direction: the face lies on the left.
struct Piece {
  int a, b, face, curve;
  bool joins = false, is_bent = false;  ///< another plate, one of them curved
};

/// A side of a triangle on the outline of a plate.
struct Outline {
  std::array<int, 2> ends;
  int face, other;      ///< the plate, and the face beside it
  int plate = -1;       ///< that joins there; -1: none
  bool is_rim = false;  ///< the body ends there
  double to_end = 0;    ///< distance to the end of the body along `out`
  Vec3 out = {};
};

class JoinedPlates {
 public:
  explicit JoinedPlates(const BodyRays& body)
      : body_(body), fine_(body.fine), near_(kNear * diagonal(fine_)), faces_(fine_.regions.size()) {}
  std::optional<Mesh> make() {
    measure_faces();
    if (!find_plates()) return std::nullopt;
    look_beside();
    choose_sides();
    move_outlines();
    divide_outlines();
    triangulate();
    const bool joins = do_join();
    check_faces();
    const bool is_rounded = std::ranges::any_of(outlines_, [&](const Outline& o) {
      return o.is_rim && o.to_end > kRounded * faces_[o.face].thickness;
    });
    if (!joins && (fault_.first >= 0 || !is_rounded)) return std::nullopt;
    if (fault_.first >= 0)
      throw InputError(
          fmt::format("{}: {}: {} [no-midsurface]", body_.source, body_.show(fault_.first), fault_.second));
    add_lines();
    return std::move(made_);
  }

 private:
  int size() const { return static_cast<int>(faces_.size()); }
  bool is_plate(int face) const { return faces_[face].plate >= 0; }

  void measure_faces() {
    for (std::size_t t = 0; t < fine_.triangles.size(); ++t) {
      const auto& v = fine_.triangles[t];
      const Vec3 x = fine_.points[v[0]];
      const Vec3 n = body_.inward_sign * cross(fine_.points[v[1]] - x, fine_.points[v[2]] - x);
      const int f = fine_.triangle_region[t];
      faces_[f].area += norm(n) / 2;
      if (norm(n) > norm(faces_[f].inwards)) faces_[f].at = x, faces_[f].inwards = n;
      for (const int i : v) inwards_[{f, i}] = inwards_[{f, i}] + n;
    }
    for (int f = 0; f < size(); ++f) {
      PlateFace& face = faces_[f];
      if (face.area > 0) face.inwards = (1 / norm(face.inwards)) * face.inwards;
      double outline = 0;
      for (const auto& [g, length] : body_.shared[f]) outline += length;
      if (outline > 0) face.width = 2 * face.area / outline;
    }
    for (auto& [key, sum] : inwards_) {
      PlateFace& face = faces_[key.first];
      if (std::abs(dot(fine_.points[key.second] - face.at, face.inwards)) > near_) face.is_flat = false;
      if (norm(sum) > 0) sum = (1 / norm(sum)) * sum;
    }
  }

  /// Plates are components of opposite faces. Returns whether there are any.
  bool find_plates() {
    for (int f = 0; f < size(); ++f) {
      PlateFace& face = faces_[f];
      std::map<int, double> areas;
      for (const BodyRays::Sample& s : body_.samples[f])
        if (s.opposite >= 0 && s.facing >= BodyRays::kParallel &&
            kWide[face.is_flat] * s.distance <= std::min(face.width, faces_[s.opposite].width))
          areas[s.opposite] += s.area;
      for (const auto& [g, area] : areas)
        if (area >= kFacing[face.is_flat && faces_[g].is_flat] * std::min(face.area, faces_[g].area))
          face.opposite.insert(g), faces_[g].opposite.insert(f);
    }
    for (int first = 0; first < size(); ++first) {
      if (is_plate(first) || faces_[first].opposite.empty()) continue;
      std::vector<int> plate = {first};
      faces_[first].plate = n_plates_++;
      for (std::size_t i = 0; i < plate.size(); ++i)
        for (const int g : faces_[plate[i]].opposite) {
          if (faces_[g].plate == faces_[first].plate && faces_[g].side == faces_[plate[i]].side) return false;
          if (is_plate(g)) continue;
          faces_[g].plate = faces_[first].plate, faces_[g].side = 1 - faces_[plate[i]].side;
          plate.push_back(g);
        }
    }
    for (int f = 0; f < size(); ++f) measure_thickness(f);
    for (PlateFace& face : faces_)
      for (const int g : face.opposite)
        if (face.thickness == 0) face.thickness = faces_[g].thickness;
    return n_plates_ > 0;
  }

  void measure_thickness(int f) {
    PlateFace& face = faces_[f];
    double sum = 0, area = 0;
    for (const BodyRays::Sample& s : body_.samples[f]) {
      if (s.facing < BodyRays::kParallel || !face.opposite.contains(s.opposite)) continue;
      const Vec3 x = face.is_flat ? s.at : body_.nearest(f, s.at);
      const double distance = face.is_flat ? s.distance : norm(body_.nearest(s.opposite, x) - x);
      face.least = std::min(face.least, distance), face.most = std::max(face.most, distance);
      sum += s.area * distance, area += s.area;
    }
    if (area > 0) face.thickness = sum / area;
  }

  /// Plates must have one thickness and be nearly all of the body. All other faces must be rims, welds or
  /// fillets.
  void check_faces() {
    if (std::abs(held_ / body_.volume - 1) > kOther)
      fault_ = {static_cast<int>(std::ranges::find(faces_, true, &PlateFace::is_chosen) - faces_.begin()),
                fmt::format("this plate and those that it joins have {:.0f} % of the body's volume. Part the "
                            "body where it is thick",
                            100 * held_ / body_.volume)};
    const double thickest = std::ranges::max_element(faces_, {}, &PlateFace::thickness)->thickness;
    for (int f = 0; f < size(); ++f) {
      const PlateFace& face = faces_[f];
      double beside = 0;
      for (const auto& [g, length] : body_.shared[f]) beside = std::max(beside, faces_[g].thickness);
      if (!is_plate(f) && face.width > kNarrow * (beside > 0 ? beside : thickest))
        fault_ = {f,
                  "no opposite side, and too wide for a rim, weld or fillet. Take the face away, or mesh "
                  "without a mid-surface"};
      if (is_plate(f) && face.most > (1 + (face.is_flat ? kSteady : kAlike)) * face.least)
        fault_ = {f, fmt::format("the thickness changes from {:.4g} to {:.4g}. Where plates join, each needs "
                                 "one thickness: part the body there",
                                 face.least, face.most)};
    }
  }

  /// Finds what lies beside the outlines of plates: another plate, also behind a weld or fillet, or a rim.
  void look_beside() {
    for_each_edge(sorted_half_edges(fine_), [&](std::span<const HalfEdge> edge) {
      for (const int k : {0, 1}) {
        const int f = region_of(fine_, edge[k].element), g = region_of(fine_, edge[1 - k].element);
        if (f != g && is_plate(f)) outlines_.push_back(look(edge[k], f, g));
      }
    });
  }
  Outline look(const HalfEdge& side, int face, int other) const {
    Outline found{side.run(), face, other, is_plate(other) ? other : -1};
    const double thickness = faces_[face].thickness, back = 0.75 * thickness;
    const Vec3 a = fine_.points[found.ends[0]], b = fine_.points[found.ends[1]];
    const Vec3 normal = body_.normal(side.element), across = cross(b - a, normal);
    if (is_plate(other) || !(norm(across) > 0)) return found;
    found.out = (1 / norm(across)) * across;
    const Vec3 from = 0.5 * (a + b) + (body_.inward_sign * thickness / 2) * normal - back * found.out;
    const BodyRays::Hit end = body_.leave(from, found.out);
    const int at_end = end.triangle < 0 ? -1 : fine_.triangle_region[end.triangle];
    found.is_rim = at_end >= 0 && end.distance <= kNarrow * thickness &&
                   (at_end == other || body_.shared[other].contains(at_end));
    found.to_end = end.distance - back;
    double longest = 0;
    for (const auto& [g, length] : body_.shared[other])
      if (!found.is_rim && is_plate(g) && faces_[g].plate != faces_[face].plate && length > longest)
        found.plate = g, longest = length;
    return found;
  }

  /// Takes the side whose outline is known, else the longer outline: it has the feet of other plates.
  void choose_sides() {
    std::vector<std::array<std::array<double, 2>, 2>> lengths(n_plates_);  // of unknown parts, and less all
    for (const Outline& o : outlines_) {
      const PlateFace &face = faces_[o.face], &other = faces_[o.other];
      if (other.plate == face.plate && other.side == face.side) continue;
      const double length = norm(fine_.points[o.ends[1]] - fine_.points[o.ends[0]]);
      if (o.plate < 0 && !o.is_rim) lengths[face.plate][face.side][0] += length;
      lengths[face.plate][face.side][1] -= length;
    }
    for (PlateFace& face : faces_)
      face.is_chosen = face.plate >= 0 && face.side == int{lengths[face.plate][1] < lengths[face.plate][0]};
  }

  /// Adds the mid-plane of a face, seen from a point of the same or of another plate.
  void add_middle(int f, int v, Planes& planes) const {
    const PlateFace& face = faces_[f];
    const Vec3 x = fine_.points[v];
    if (face.is_flat) return planes.add(face.inwards, dot(face.inwards, face.at - x) + face.thickness / 2);
    const auto inwards = inwards_.find({f, v});
    const Vec3 to_face = body_.nearest(f, x) - x;
    if (inwards == inwards_.end() && norm(to_face) > near_)
      return planes.add((1 / norm(to_face)) * to_face, norm(to_face) + face.thickness / 2);
    for (const int g : face.opposite) {
      const Vec3 way = body_.nearest(g, x) - x;
      if (std::abs(norm(way) / face.thickness - 1) < kAlike)
        return planes.add((1 / norm(way)) * way, norm(way) / 2);
    }
    planes.add(inwards == inwards_.end() ? face.inwards : inwards->second, face.thickness / 2);
  }

  /// Moves the points of chosen faces half-way, and their outlines to where plates join or end.
  void move_outlines() {
    std::vector<std::map<int, Planes>> moves(faces_.size());
    for (const auto& [key, sum] : inwards_)
      if (const auto& [f, v] = key; faces_[f].is_chosen) add_middle(f, v, moves[f][v]);
    for (const Outline& o : outlines_)
      for (const int v : o.ends)
        if (!faces_[o.face].is_chosen)
          continue;
        else if (o.is_rim)
          moves[o.face][v].add(o.out, o.to_end);
        else if (o.plate >= 0)
          add_middle(o.plate, v, moves[o.face][v]);
    for (int f = 0; f < size(); ++f)
      for (const auto& [v, planes] : moves[f]) {
        index_[{f, v}] = static_cast<int>(points_.size());
        points_.push_back(fine_.points[v] + planes.shift());
      }
    std::map<std::pair<int, int>, int> curves;
    for (std::size_t l = 0; l < fine_.lines.size(); ++l)
      curves[std::minmax(fine_.lines[l][0], fine_.lines[l][1])] = fine_.line_curve[l];
    made_.curves = fine_.curves;
    for (const auto& [ends, f, other, plate, is_rim, to_end, out] : outlines_) {
      if (!faces_[f].is_chosen) continue;
      const int curve = curves.at(std::minmax(ends[0], ends[1]));
      const bool joins = plate >= 0, bends = joins && !(faces_[f].is_flat && faces_[plate].is_flat);
      pieces_.push_back({index_.at({f, ends[0]}), index_.at({f, ends[1]}), f, curve, joins, bends});
      if (!is_plate(other))
        add_names(fine_.regions[other].names, fine_.regions[f].names, made_.curves[curve].names);
    }
  }

  /// Adds a point where two pieces cross.
  void add_crossings() {
    std::vector<Box<Vec3>> boxes;
    for (const Piece& p : pieces_)
      boxes.push_back(Box<Vec3>::around({points_[p.a], points_[p.b]}).grown(near_));
    const BoxTree<Vec3> tree(boxes);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Vec3 x = points_[pieces_[i].a], u = points_[pieces_[i].b] - x;
      tree.overlapping(boxes[i], [&](int j) {
        if (j <= static_cast<int>(i)) return;
        const Vec3 y = points_[pieces_[j].a], w = points_[pieces_[j].b] - y, n = cross(u, w);
        if (norm(n) <= kNear * norm(u) * norm(w)) return;
        const double s = dot(cross(y - x, w), n) / dot(n, n), t = dot(cross(y - x, u), n) / dot(n, n);
        if (s > 0 && s < 1 && t > 0 && t < 1 && norm(x + s * u - y - t * w) <= near_)
          points_.push_back(x + s * u);
      });
    }
  }

  /// Makes points one that coincide, and cuts pieces at all points on them.
  void divide_outlines() {
    add_crossings();
    std::vector<Box<Vec3>> boxes;
    for (const Vec3& x : points_) boxes.push_back({x, x});
    const BoxTree<Vec3> tree(boxes);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      int name = static_cast<int>(i);
      tree.overlapping(boxes[i].grown(near_), [&](int j) {
        if (j < name && norm(points_[j] - points_[i]) <= near_) name = names_[j];
      });
      names_.push_back(name);
    }
    std::vector<char> is_bent(points_.size(), 0);
    for (const Piece& p : pieces_)
      if (p.is_bent) is_bent[names_[p.a]] = is_bent[names_[p.b]] = 1;
    std::vector<Piece> parts;
    for (const Piece& p : pieces_) {
      const Vec3 x = points_[p.a], y = points_[p.b];
      const double reach = p.is_bent ? kBent * norm(y - x) : near_;
      std::vector<std::pair<double, int>> on = {{0, names_[p.a]}, {1, names_[p.b]}};
      tree.overlapping(Box<Vec3>::around({x, y}).grown(reach), [&](int j) {
        const double at = nearest_part(points_[j], x, y);
        if (names_[j] == j && j != on[0].second && j != on[1].second && at > 0 && at < 1 &&
            norm(points_[j] - x - at * (y - x)) <= (is_bent[j] ? reach : near_))
          on.emplace_back(at, j);
      });
      std::ranges::sort(on);
      for (std::size_t k = 0; k + 1 < on.size(); ++k) {
        if (on[k].second == on[k + 1].second) continue;
        parts.push_back({on[k].second, on[k + 1].second, p.face, p.curve, p.joins});
        if (k > 0) inside_[{p.face, on[0].second, on.back().second}].push_back(on[k].second);
      }
    }
    pieces_ = std::move(parts);
  }

  /// Returns whether three triangles meet at an edge. Outlines beside plates must meet them.
  bool do_join() {
    bool joins = false;
    std::set<std::pair<int, int>> open;
    for_each_edge(sorted_half_edges(made_), [&](std::span<const HalfEdge> edge) {
      joins = joins || edge.size() > 2;
      if (edge.size() == 1) open.emplace(edge[0].lo, edge[0].hi);
    });
    std::map<int, std::array<double, 2>> lengths;  // by face: all, and open ones
    for (const Piece& p : pieces_) {
      if (!p.joins) continue;
      const double length = norm(points_[p.b] - points_[p.a]);
      auto& [all, alone] = lengths[p.face];
      all += length;
      if (open.contains(std::minmax(p.a, p.b))) alone += length;
    }
    for (const auto& [f, length] : lengths)
      if (length[1] > kAlike * length[0])
        fault_ = {f, "its mid-surface misses the plates beside it. Part the body there"};
    return joins;
  }

  void add_triangle(std::array<int, 3> v, int face) {
    const Vec3 &x = made_.points[v[0]], &y = made_.points[v[1]], &z = made_.points[v[2]];
    held_ += norm(cross(y - x, z - x)) / 2 * faces_[face].thickness;
    made_.triangles.push_back(v);
    made_.triangle_region.push_back(face);
    made_.thickness.push_back(faces_[face].thickness);
  }

  /// Adds a triangle of a curved face as a fan, if its outline was cut.
  void add_cut_triangle(const std::array<int, 3>& v, int face) {
    std::vector<int> ring;
    for (int k = 0; k < 3; ++k) {
      ring.push_back(v[k]);
      if (const auto cut = inside_.find({face, v[k], v[(k + 1) % 3]}); cut != inside_.end())
        ring.insert(ring.end(), cut->second.begin(), cut->second.end());
    }
    if (ring.size() == 3) return add_triangle(v, face);
    made_.points.push_back((1.0 / 3) * (points_[v[0]] + points_[v[1]] + points_[v[2]]));
    for (std::size_t k = 0; k < ring.size(); ++k)
      add_triangle({static_cast<int>(made_.points.size()) - 1, ring[k], ring[(k + 1) % ring.size()]}, face);
  }

  void triangulate() {
    made_.points = points_;
    std::vector<std::vector<Piece>> outlines(faces_.size());
    for (const Piece& p : pieces_) outlines[p.face].push_back(p);
    for (std::size_t t = 0; t < fine_.triangles.size(); ++t) {
      const int f = fine_.triangle_region[t];
      if (!faces_[f].is_chosen || faces_[f].is_flat) continue;
      std::array<int, 3> v = fine_.triangles[t];
      for (int& i : v) i = names_[index_.at({f, i})];
      add_cut_triangle(v, f);
    }
    for (int f = 0; f < size(); ++f)
      if (faces_[f].is_chosen && faces_[f].is_flat && !outlines[f].empty()) triangulate(f, outlines[f]);
  }

  void triangulate(int f, const std::vector<Piece>& outline) {
    const Vec3 n = body_.inward_sign * faces_[f].inwards;
    const Vec3 axis = std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, across = cross(n, axis);
    const Vec3 u = (1 / norm(across)) * across, w = cross(n, u), from = points_[outline[0].a];
    PatchBoundary patch;
    std::vector<int> number;  // of each of its points
    std::map<int, int> place;
    const auto flat = [&](const Vec3& x) { return Vec2{dot(x - from, u), dot(x - from, w)}; };
    std::set<std::pair<int, int>> edges;
    const auto add = [&](int a, int b) {
      if (!edges.emplace(a, b).second) return;
      for (const int i : {a, b})
        if (place.try_emplace(i, static_cast<int>(number.size())).second) {
          number.push_back(i);
          patch.points.push_back(flat(points_[i]));
        }
      patch.edges.push_back({place[a], place[b]});
    };
    for (const Piece& p : outline) add(p.a, p.b);
    const auto sides = patch.edges;
    const auto is_inside = [&](Vec2 x) {
      bool inside = false;
      for (const auto& [i, j] : sides) {
        const Vec2 a = patch.points[i], b = patch.points[j];
        if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x))
          inside = !inside;
      }
      return inside;
    };
    for (const Piece& p : pieces_) {
      const Vec3 a = points_[p.a], b = points_[p.b];
      if (p.face == f || edges.contains({p.a, p.b}) || edges.contains({p.b, p.a}) ||
          std::abs(dot(a - from, n)) > near_ || std::abs(dot(b - from, n)) > near_ ||
          !is_inside(flat(0.5 * (a + b))))
        continue;
      add(p.a, p.b);
      add(p.b, p.a);
    }
    try {
      for (const auto& [a, b, c] : constrained_delaunay(patch).triangles)
        add_triangle({number[a], number[b], number[c]}, f);
    } catch (const InputError& error) {
      fault_ = {f, fmt::format("its mid-surface has no clear outline ({}). Mesh its faces without a "
                               "mid-surface",
                               error.what())};
    }
  }

  /// Adds names, and lines along outlines, but for the two sides of a slit that nothing joins.
  void add_lines() {
    made_.regions = fine_.regions;
    for (int f = 0; f < size(); ++f)
      for (const int g : faces_[f].opposite)
        if (faces_[f].is_chosen) add_names(fine_.regions[g].names, {}, made_.regions[f].names);
    std::map<std::pair<int, int>, std::vector<const Piece*>> at;
    for (const Piece& p : pieces_) at[std::minmax(p.a, p.b)].push_back(&p);
    for (const auto& [ends, pieces] : at) {
      const Piece& p = *pieces[0];
      if (pieces.size() == 2 && pieces[1]->face == p.face) continue;
      made_.lines.push_back({p.a, p.b});
      made_.line_curve.push_back(p.curve);
    }
  }

  const BodyRays& body_;
  const Mesh& fine_;
  double near_;
  std::vector<PlateFace> faces_;
  std::map<std::pair<int, int>, Vec3> inwards_;  ///< by face and point
  int n_plates_ = 0;
  std::map<std::pair<int, int>, int> index_;  ///< into points_, by face and point
  std::vector<Vec3> points_;
  std::vector<int> names_;  ///< the point in place of each
  std::vector<Outline> outlines_;
  std::vector<Piece> pieces_;
  double held_ = 0;                                               ///< volume of plates
  std::map<std::tuple<int, int, int>, std::vector<int>> inside_;  ///< points, by face and ends of a piece
  std::pair<int, std::string> fault_ = {-1, ""};                  ///< a face, and what is wrong there
  Mesh made_;
};

}  // namespace

std::optional<Mesh> join_plates(const BodyRays& body) { return JoinedPlates(body).make(); }

}  // namespace delquad
