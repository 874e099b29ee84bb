#include "geometry/cad/loose_joints.h"

#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "base/box.h"
#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/disjoint_sets.h"
#include "geometry/cad/cad_shape.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad::cad {

namespace {

using Pair = std::array<int, 2>;
using Places = std::vector<Vec3>;

Pair in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Part of a chord: its middle is not nearer to a face that the curve leaves in a tangent direction. An arc
/// that turns by .15 rises .019 above its chord.
constexpr double kPartOfChord = 0.01;
/// Where two faces cross is found by going from one to the other, which takes so many steps where they meet
/// at 15 degrees; steps that are no shorter than this part of the one before lead nowhere.
constexpr int kMostMeetingSteps = 200;
constexpr double kStepsShrink = 0.97;
/// Places where triangles of two faces are nearest to each other: so many are tried, the nearest first.
constexpr std::size_t kMostStarts = 20;
/// Two triangles are followed from one to the other so often, which need not reach the nearest places.
constexpr int kMostExchanges = 8;
/// Faces come nearer by steps that lower their distance to this part, and are as long as this part of it.
constexpr double kNearer = 0.9, kShortestStep = 0.25;
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Of two ascending lists.
std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both;
}

/// Where the segment from p to q meets the triangle, its outline included.
std::optional<Vec3> meeting(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kRounding = 1e-9;
  const Vec3 normal = cross(b - a, c - a);
  const double from = dot(p - a, normal), to = dot(q - a, normal);
  if (from * to > 0 || from == to) return std::nullopt;
  const Vec3 x = p + (from / (from - to)) * (q - p);
  const double least = -kRounding * dot(normal, normal);
  for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
    if (dot(cross(v - u, x - u), normal) < least) return std::nullopt;
  return x;
}

/// A triangle of a face, or a chord of a curve, whose end stands twice.
struct Piece {
  std::array<Vec3, 3> at;
  int face, curve;  ///< curve -1: of the face

  Box<Vec3> box() const { return Box<Vec3>::around(at); }
  double length() const { return std::max(norm(at[1] - at[0]), norm(at[2] - at[0])); }
  Vec3 nearest(const Vec3& x) const {
    const auto w = nearest_weights(at[0], at[1], at[2], x);
    return w[0] * at[0] + w[1] * at[1] + w[2] * at[2];
  }
};

/// A place of one next to the other.
struct Approach {
  double apart = std::numeric_limits<double>::infinity();
  Vec3 at;
  Piece from, to;
};

class JointFinder {
 public:
  JointFinder(const SurfaceModel& model, const std::vector<std::vector<int>>& shells, double deflection,
              double tolerance)
      : model_(model),
        mesh_(model.fine),
        deflection_(deflection),
        tolerance_(tolerance),
        sides_(sorted_half_edges(mesh_)),
        faces_(mesh_.regions.size()) {
    for (int s = 0; s < std::ssize(shells); ++s)
      for (const int f : shells[s]) faces_[f].shells.push_back(s);
    for (int t = 0; t < std::ssize(mesh_.triangles); ++t) faces_[face_of(t)].triangles.push_back(t);
    for (Face& face : faces_) set_box(face);
    find_lines();
    find_parts();
  }

  std::vector<LooseJoint> find() {
    using Kind = LooseJoint::Kind;
    std::vector<Pair> pairs = near_pairs();
    const auto try_all = [&](auto found) {  // the first face with the second, else the second with the first
      for (const auto& [f, g] : pairs)
        if (!joined_.contains({f, g}) && !found(f, g)) found(g, f);
    };
    try_all([&](int f, int g) { return add(Kind::kFaces, f, g, common_area(f, g)); });
    std::erase_if(pairs, [&](const Pair& pair) { return are_of_one_shell(pair[0], pair[1]); });
    try_all([&](int f, int g) { return add_line_joint(f, g); });
    try_all([&](int f, int g) { return add(Kind::kCrossing, f, g, crossing(f, g)); });
    try_all([&](int f, int g) { return add(Kind::kTouch, f, g, touching(f, g)); });
    std::ranges::sort(joints_, {}, [](const LooseJoint& j) { return in_order(j.faces[0], j.faces[1]); });
    return std::move(joints_);
  }

  /// `joints`: of all that touch.
  std::vector<NearContact> find_near(const std::vector<LooseJoint>& joints) {
    std::set<Pair> touching;
    for (const LooseJoint& j : joints) touching.insert(parts_of(j.faces[0], j.faces[1]));
    std::map<std::array<int, 4>, NearContact> nearest;  // by parts, of one part by faces
    const auto measure = [&](const Vec3& x, int f, int g) {
      const double apart = distance(x, g, tolerance_);
      if (!(apart <= tolerance_)) return;
      const auto [p, q] = parts_of(f, g);
      const auto [r, s] = p == q ? in_order(f, g) : Pair{0, 0};
      const auto [at, is_new] = nearest.try_emplace({p, q, r, s}, NearContact{{f, g}, x, apart});
      if (!is_new && apart < at->second.distance) at->second = {{f, g}, x, apart};
    };
    for (const auto& [a, b] : near_pairs()) {
      const bool is_one_part = faces_[a].part == faces_[b].part;
      if (is_one_part ? !common(faces_[a].nodes, faces_[b].nodes).empty() : touching.contains(parts_of(a, b)))
        continue;
      for (const auto& [f, g] : {Pair{a, b}, Pair{b, a}}) {
        check_cancelled();
        for (const int l : faces_[f].lines) {
          const auto& [v, w] = mesh_.lines[l];
          const Vec3 &p = mesh_.points[v], &q = mesh_.points[w];
          if (!Box<Vec3>::around({p, q}).overlaps(faces_[g].box)) continue;
          if (is_one_part && sides_of_edge(sides_, v, w).size() > 1) continue;
          for (const Vec3& x : {p, q, model_.projector->to_curve(mesh_.line_curve[l], 0.5 * (p + q))})
            measure(x, f, g);
        }
        for (const int t : faces_[f].triangles)
          if (!is_one_part && box_of(t).overlaps(faces_[g].box))
            measure(model_.projector->to_face(f, 1.0 / 3 * (corner(t, 0) + corner(t, 1) + corner(t, 2))), f,
                    g);
      }
    }
    std::vector<NearContact> contacts;
    for (const auto& [key, contact] : nearest) contacts.push_back(contact);
    return contacts;
  }

 private:
  struct Trees {
    NearestTriangle nearest;
    BoxTree<Vec3> boxes;
  };
  struct Face {
    std::vector<int> triangles, shells, lines, nodes;  ///< ascending; the nodes on lines
    Box<Vec3> box{};
    int part = -1;
    std::unique_ptr<Trees> trees{};
  };

  int face_of(int triangle) const { return mesh_.triangle_region[triangle]; }
  const Vec3& corner(int t, int k) const { return mesh_.points[mesh_.triangles[t][k]]; }
  Box<Vec3> box_of(int t) const { return Box<Vec3>::around({corner(t, 0), corner(t, 1), corner(t, 2)}); }

  void set_box(Face& face) const {
    if (face.triangles.empty()) return;
    face.box = box_of(face.triangles[0]);
    for (const int t : face.triangles)
      for (int k = 0; k < 3; ++k) face.box.add(corner(t, k));
    face.box = face.box.grown(deflection_ + tolerance_);
  }

  void find_lines() {
    for (int l = 0; l < std::ssize(mesh_.lines); ++l) {
      const auto& [a, b] = mesh_.lines[l];
      line_on_[in_order(a, b)] = l;
      for (const HalfEdge& side : sides_of_edge(sides_, a, b)) {
        Face& face = faces_[face_of(side.element)];
        if (face.lines.empty() || face.lines.back() != l) face.lines.push_back(l);
        face.nodes.insert(face.nodes.end(), {a, b});
      }
    }
    for (Face& face : faces_) std::ranges::sort(face.nodes);
  }

  void find_parts() {
    DisjointSets parts(faces_.size());
    for_each_edge(sides_, [&](std::span<const HalfEdge> edge) {
      for (const HalfEdge& side : edge) parts.join(face_of(edge[0].element), face_of(side.element));
    });
    for (int f = 0; f < std::ssize(faces_); ++f) faces_[f].part = parts.root(f);
    is_open_.assign(faces_.size(), 0);
    for_each_edge(sides_, [&](std::span<const HalfEdge> edge) {
      if (edge.size() == 1) is_open_[faces_[face_of(edge[0].element)].part] = 1;
    });
  }

  bool are_of_one_shell(int f, int g) const {
    const Face &first = faces_[f], &second = faces_[g];
    return (first.part == second.part && is_open_[first.part] == 0 &&
            (first.shells.empty() || second.shells.empty())) ||
           std::ranges::any_of(first.shells,
                               [&](int s) { return std::ranges::binary_search(second.shells, s); });
  }

  /// Whether all lines of one are lines of the other.
  bool have_one_rim(int f, int g) const {
    const std::vector<int>&first = faces_[f].lines, &second = faces_[g].lines;
    return !first.empty() && !second.empty() &&
           (std::ranges::includes(first, second) || std::ranges::includes(second, first));
  }

  /// Faces whose boxes meet, and that are not of one closed shell, or have one rim.
  std::vector<Pair> near_pairs() const {
    std::vector<int> order;
    for (int f = 0; f < std::ssize(faces_); ++f)
      if (!faces_[f].triangles.empty()) order.push_back(f);
    std::ranges::sort(order, {}, [&](int f) { return faces_[f].box.low.x; });
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < order.size(); ++i) {
      check_cancelled();
      const Face& first = faces_[order[i]];
      for (std::size_t j = i + 1; j < order.size() && faces_[order[j]].box.low.x <= first.box.high.x; ++j) {
        if (!first.box.overlaps(faces_[order[j]].box)) continue;
        if (!are_of_one_shell(order[i], order[j]) || have_one_rim(order[i], order[j]))
          pairs.push_back(in_order(order[i], order[j]));
      }
    }
    std::ranges::sort(pairs);
    return pairs;
  }

  Pair parts_of(int f, int g) const { return in_order(faces_[f].part, faces_[g].part); }

  /// The first of the places where no joint of the same parts is known.
  bool add(LooseJoint::Kind kind, int f, int g, const Places& places) {
    for (const Vec3& x : places) {
      const bool is_known = std::ranges::any_of(joints_, [&](const LooseJoint& j) {
        return parts_of(j.faces[0], j.faces[1]) == parts_of(f, g) && is_on(x, j.faces[0], tolerance_) &&
               is_on(x, j.faces[1], tolerance_);
      });
      if (is_known) continue;
      joints_.push_back({kind, {f, g}, x});
      joined_.insert(in_order(f, g));
      return true;
    }
    return false;
  }

  /// A place inside a triangle of f that is a place of g.
  Places common_area(int f, int g) {
    constexpr double kNear = 2.0 / 3, kFar = 1.0 / 6;
    for (const int t : faces_[f].triangles) {
      if (!box_of(t).overlaps(faces_[g].box)) continue;
      const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
      for (const Vec3& place : {1.0 / 3 * (a + b + c), kNear * a + kFar * (b + c), kNear * b + kFar * (c + a),
                                kNear * c + kFar * (a + b)})
        if (faces_[g].box.distance2(place) == 0 && is_near(place, g))
          if (const Vec3 x = model_.projector->to_face(f, place); is_on(x, g, tolerance_)) return {x};
    }
    return {};
  }

  /// Where lines of f that are not those of g lie on it. Of one part only free lines count.
  bool add_line_joint(int f, int g) {
    Places middles, ends;
    for (const int l : faces_[f].lines) {
      const auto& [a, b] = mesh_.lines[l];
      const Vec3 &p = mesh_.points[a], &q = mesh_.points[b];
      if (!Box<Vec3>::around({p, q}).overlaps(faces_[g].box)) continue;
      if (std::ranges::binary_search(faces_[g].lines, l)) continue;
      if (faces_[f].part == faces_[g].part && sides_of_edge(sides_, a, b).size() > 1) continue;
      const double reach = std::min(tolerance_, kPartOfChord * norm(q - p));
      if (const Vec3 x = 0.5 * (p + q); is_near(x, g))
        if (const Vec3 y = model_.projector->to_curve(mesh_.line_curve[l], x); is_on(y, g, reach))
          middles.push_back(y);
      for (const int v : {a, b})
        if (!std::ranges::binary_search(faces_[g].nodes, v) && is_on(mesh_.points[v], g, reach))
          ends.push_back(mesh_.points[v]);
    }
    return add(LooseJoint::Kind::kEdge, f, g, middles) || add(LooseJoint::Kind::kCorner, f, g, ends);
  }

  /// Whether a place is not next to what both share: triangles of neighbours may cross there.
  auto away_from_shared(int f, int g) const {
    return [this, nodes = common(faces_[f].nodes, faces_[g].nodes),
            lines = common(faces_[f].lines, faces_[g].lines)](const Vec3& x) {
      return std::ranges::none_of(nodes,
                                  [&](int v) { return norm(mesh_.points[v] - x) <= 2 * deflection_; }) &&
             std::ranges::none_of(lines, [&](int l) {
               const Vec3 &a = mesh_.points[mesh_.lines[l][0]], &b = mesh_.points[mesh_.lines[l][1]];
               const auto w = nearest_weights(a, b, b, x);
               return norm(w[0] * a + (w[1] + w[2]) * b - x) <= 2 * deflection_;
             });
    };
  }

  /// A place where a side of a triangle of f goes through g.
  Places crossing(int f, int g) {
    constexpr std::array<Pair, 3> kSides{{{0, 1}, {1, 2}, {2, 0}}};
    const auto is_apart = away_from_shared(f, g);
    for (const int t : faces_[f].triangles)
      for (const auto& [i, k] : kSides) {
        const Vec3 &p = corner(t, i), &q = corner(t, k);
        const auto box = Box<Vec3>::around({p, q});
        if (!box.overlaps(faces_[g].box)) continue;
        Places found;
        trees_of(g).boxes.overlapping(box, [&](int n) {
          const int s = faces_[g].triangles[n];
          if (!found.empty() || !box_of(s).overlaps(box)) return;
          const auto x = meeting(p, q, corner(s, 0), corner(s, 1), corner(s, 2));
          if (!x || !is_apart(*x)) return;
          if (const auto y = on_both(*x, f, g)) found.push_back(*y);
        });
        if (!found.empty()) return found;
      }
    return {};
  }

  /// The place of both faces next to one of their triangles' places.
  std::optional<Vec3> on_both(Vec3 x, int f, int g) {
    double before = 2 * deflection_ + tolerance_;
    for (int step = 0; step < kMostMeetingSteps; ++step) {
      const Vec3 y = model_.projector->to_face(g, x);
      const double apart = norm(y - x);
      x = model_.projector->to_face(f, y);
      if (apart <= tolerance_) break;
      if (!(apart < kStepsShrink * before)) return std::nullopt;
      before = apart;
    }
    return is_on(x, f, tolerance_) && is_on(x, g, tolerance_) ? std::optional(x) : std::nullopt;
  }

  Piece triangle(int t) const { return {{corner(t, 0), corner(t, 1), corner(t, 2)}, face_of(t), -1}; }
  Piece chord(int l, int f) const {
    const Vec3 &p = mesh_.points[mesh_.lines[l][0]], &q = mesh_.points[mesh_.lines[l][1]];
    return {{p, q, q}, f, mesh_.line_curve[l]};
  }
  Vec3 project(const Piece& to, const Vec3& x) const {
    return to.curve < 0 ? model_.projector->to_face(to.face, x) : model_.projector->to_curve(to.curve, x);
  }

  /// A place where f, or a curve of it, touches g: as a ball does a table, a wheel a road, two rings.
  Places touching(int f, int g) {
    std::vector<Approach> all;
    for (const int t : faces_[f].triangles) add_approaches(triangle(t), g, all);
    for (const int l : faces_[f].lines)
      if (!std::ranges::binary_search(faces_[g].lines, l)) add_approaches(chord(l, f), g, all);
    const auto is_apart = away_from_shared(f, g);
    std::erase_if(all, [&](const Approach& approach) {
      return !is_apart(approach.at) || (approach.apart <= tolerance_ && !is_on(approach.at, g, tolerance_));
    });
    std::ranges::stable_sort(all, {}, &Approach::apart);
    all.resize(std::min(all.size(), kMostStarts));
    for (const Approach& approach : all)
      if (const Vec3 x = come_nearer(approach);
          is_apart(x) && is_on(x, f, tolerance_) && is_on(x, g, tolerance_))
        return {x};
    return {};
  }

  /// Where a piece is nearest to g, and to its curves if it is of one, if that may be a common place.
  void add_approaches(const Piece& from, int g, std::vector<Approach>& all) {
    const double reach = 2 * deflection_ + tolerance_;
    const Box<Vec3> box = from.box().grown(reach);
    if (!box.overlaps(faces_[g].box)) return;
    std::array<Approach, 2> nearest;  // to a triangle, to a chord
    const auto offer = [&](const Piece& to) {
      if (!box.overlaps(to.box())) return;
      Vec3 x = 1.0 / 3 * (from.at[0] + from.at[1] + from.at[2]), y = x;
      for (int k = 0; k < kMostExchanges; ++k) {
        y = to.nearest(x);
        x = from.nearest(y);
      }
      Approach& known = nearest[to.curve >= 0];
      if (const double apart = norm(x - y); apart <= reach && apart < known.apart)
        known = {apart, x, from, to};
    };
    trees_of(g).boxes.overlapping(box, [&](int n) {
      const int t = faces_[g].triangles[n];
      offer(triangle(t));
      for (int k = 0; from.curve >= 0 && k < 3; ++k)
        if (const auto line = line_on_.find(in_order(mesh_.triangles[t][k], mesh_.triangles[t][(k + 1) % 3]));
            line != line_on_.end())
          offer(chord(line->second, g));
    });
    for (Approach& at : nearest) {
      if (std::isinf(at.apart)) continue;
      at.at = project(at.from, at.at);
      at.apart = norm(at.at - project(at.to, at.at));
      if (std::isfinite(at.apart)) all.push_back(at);
    }
  }

  /// The place of one that is nearest to the other, by steps along it that are halved where they lead
  /// nowhere.
  Vec3 come_nearer(const Approach& approach) const {
    auto [apart, x, from, to] = approach;
    const Vec3 along = from.at[1] - from.at[0], across = cross(cross(along, from.at[2] - from.at[0]), along);
    std::vector<Vec3> ways;
    for (const Vec3& way : {along, across})
      if (const double length = norm(way); length > 0 && (from.curve < 0 || ways.empty()))
        for (const double sign : {1.0, -1.0}) ways.push_back(sign / length * way);
    double step = std::min(from.length(), to.length());
    while (step > tolerance_ && step >= kShortestStep * apart) {
      bool comes_nearer = false;
      for (const Vec3& way : ways) {
        const Vec3 y = project(from, x + step * way);
        const double distance = norm(y - project(to, y));
        if (!(distance < kNearer * apart)) continue;
        x = y;
        apart = distance;
        comes_nearer = true;
      }
      if (!comes_nearer) step /= 2;
    }
    return x;
  }

  /// The nearest triangle on points of its own: as many as it has corners.
  Trees& trees_of(int g) {
    if (faces_[g].trees) return *faces_[g].trees;
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<Box<Vec3>> boxes;
    for (const int t : faces_[g].triangles) {
      const int n = static_cast<int>(points.size());
      for (int k = 0; k < 3; ++k) points.push_back(corner(t, k));
      triangles.push_back({n, n + 1, n + 2});
      boxes.push_back(box_of(t));
    }
    faces_[g].trees = std::make_unique<Trees>(
        Trees{NearestTriangle(std::move(points), std::move(triangles)), BoxTree<Vec3>(boxes)});
    return *faces_[g].trees;
  }

  bool is_near(const Vec3& x, int g) {
    return trees_of(g).nearest.find(x, 3 * deflection_ + tolerance_).triangle >= 0;
  }

  bool is_on(const Vec3& x, int g, double tolerance) { return distance(x, g, tolerance) <= tolerance; }

  /// Of x from g, if it is no more than `reach`, else more than that. The triangles tell where the face is,
  /// its surface how far, its curves where it ends.
  double distance(const Vec3& x, int g, double reach) {
    if (!(faces_[g].box.distance2(x) <= reach * reach)) return kNowhere;
    const NearestTriangle::Found found = trees_of(g).nearest.find(x, 2 * deflection_ + reach);
    if (found.triangle < 0) return kNowhere;
    const double apart = norm(model_.projector->to_face(g, x) - x);
    return apart <= reach ? std::max(apart, beyond(x, faces_[g].triangles[found.triangle], found.weights))
                          : apart;
  }

  /// How far x, next to a place of a triangle, is from the boundary of its face if it is beyond that, else 0.
  double beyond(const Vec3& x, int t, const std::array<double, 3>& weights) const {
    const auto& v = mesh_.triangles[t];
    if (const auto whole = std::ranges::find(weights, 1.0); whole != weights.end())
      return beyond_corner(x, face_of(t), v[whole - weights.begin()]);
    const Vec3 normal = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    double most = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      const Vec3 inwards = cross(normal, mesh_.points[b] - mesh_.points[a]);
      if (dot(x - mesh_.points[a], inwards) > 2 * deflection_ * norm(inwards)) continue;
      const auto line = line_on_.find(in_order(a, b));
      if (line == line_on_.end() || !ends_at(face_of(t), line->second)) continue;
      const Vec3 beside = x - model_.projector->to_curve(mesh_.line_curve[line->second], x);
      if (!(dot(beside, inwards) > 0)) most = std::max(most, norm(beside));
    }
    return most;
  }

  /// The same where a node is the nearest place of the face: beyond it, if it is one of the boundary.
  double beyond_corner(const Vec3& x, int f, int node) const {
    double least = kNowhere;
    for (const int l : faces_[f].lines)
      if (std::ranges::count(mesh_.lines[l], node) > 0 && ends_at(f, l))
        least = std::min(least, norm(model_.projector->to_curve(mesh_.line_curve[l], x) - x));
    return least < kNowhere ? least : 0;
  }

  /// Whether the face lies on one side of the line.
  bool ends_at(int f, int line) const {
    return std::ranges::count_if(sides_of_edge(sides_, mesh_.lines[line][0], mesh_.lines[line][1]),
                                 [&](const HalfEdge& s) { return face_of(s.element) == f; }) == 1;
  }

  const SurfaceModel& model_;
  const Mesh& mesh_;
  double deflection_, tolerance_;
  std::vector<HalfEdge> sides_;
  std::vector<Face> faces_;
  std::map<Pair, int> line_on_;  ///< by its ends
  std::vector<char> is_open_;    ///< by part
  std::vector<LooseJoint> joints_;
  std::set<Pair> joined_;  ///< faces with a joint, in order
};

/// Whether a face goes on all around a vertex of its own.
bool is_inside(const TopoDS_Face& face, const TopoDS_Shape& vertex,
               const TopTools_IndexedDataMapOfShapeListOfShape& faces_of) {
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
    if (!parts(edge, TopAbs_VERTEX).Contains(vertex) || BRep_Tool::Degenerated(edge)) continue;
    const TopTools_ListOfShape& with_edge = faces_of.FindFromKey(edge);
    if (!BRep_Tool::IsClosed(edge, face) ||
        !std::all_of(with_edge.begin(), with_edge.end(), [&](const auto& f) { return f.IsSame(face); }))
      return false;
  }
  return true;
}

}  // namespace

std::vector<LooseJoint> joints_at_points(const TopTools_IndexedMapOfShape& faces) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  for (int f = 1; f <= faces.Extent(); ++f)
    for (const TopAbs_ShapeEnum kind : {TopAbs_EDGE, TopAbs_VERTEX})
      TopExp::MapShapesAndAncestors(faces(f), kind, TopAbs_FACE, faces_of);
  // Faces that hang together may meet in a point, as a pocket may touch the floor: that is meshed.
  DisjointSets hanging(faces.Extent());
  for (int e = 1; e <= faces_of.Extent(); ++e)
    if (faces_of.FindKey(e).ShapeType() == TopAbs_EDGE)
      for (const TopoDS_Shape& face : faces_of(e))
        hanging.join(faces.FindIndex(faces_of(e).First()) - 1, faces.FindIndex(face) - 1);
  const auto part_of = [&](const TopoDS_Shape& face) { return hanging.root(faces.FindIndex(face) - 1); };
  std::vector<LooseJoint> joints;
  for (int v = 1; v <= faces_of.Extent(); ++v) {
    const TopoDS_Shape& vertex = faces_of.FindKey(v);
    if (vertex.ShapeType() != TopAbs_VERTEX) continue;
    const TopTools_ListOfShape& all = faces_of(v);
    const auto other = std::find_if(
        all.begin(), all.end(), [&](const TopoDS_Shape& f) { return part_of(f) != part_of(all.First()); });
    if (other == all.end()) continue;
    for (const TopoDS_Shape& face : all) {
      if (!is_inside(TopoDS::Face(face), vertex, faces_of)) continue;
      const TopoDS_Shape& touched = part_of(face) == part_of(all.First()) ? *other : all.First();
      joints.push_back({LooseJoint::Kind::kTouch,
                        {faces.FindIndex(face) - 1, faces.FindIndex(touched) - 1},
                        vec_of(BRep_Tool::Pnt(TopoDS::Vertex(vertex)))});
      break;
    }
  }
  return joints;
}

std::vector<LooseJoint> loose_joints(const SurfaceModel& model, const std::vector<std::vector<int>>& shells,
                                     double deflection, double tolerance) {
  return model.fine.regions.size() < 2 ? std::vector<LooseJoint>{}
                                       : JointFinder(model, shells, deflection, tolerance).find();
}

std::vector<NearContact> near_contacts(const SurfaceModel& model, const std::vector<std::vector<int>>& shells,
                                       const std::vector<LooseJoint>& joints, double deflection,
                                       double reach) {
  return model.fine.regions.size() < 2 ? std::vector<NearContact>{}
                                       : JointFinder(model, shells, deflection, reach).find_near(joints);
}

}  // namespace delquad::cad
