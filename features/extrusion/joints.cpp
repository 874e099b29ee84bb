// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extrusion/joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {

namespace {

int corner_at(const std::array<int, 4>& quad, int point) {
  return static_cast<int>(std::ranges::find(quad, point) - quad.begin());
}

/// The angle of a quad about the line from a to b.
double angle_about(const Mesh& mesh, int quad, int a, int b) {
  const Vec3 &from = mesh.points[a], along = mesh.points[b] - from;
  Vec3 centre;
  for (const int v : mesh.quads[quad]) centre = centre + 0.25 * mesh.points[v];
  const Vec3 first = unit_across(along), second = (1 / norm(along)) * cross(along, first);
  return std::atan2(dot(centre - from, second), dot(centre - from, first));
}

/// Splits the quads around a point into parts that edges of two quads connect. Each part sees each joint at
/// the point once.
std::vector<std::vector<int>> parts_at(const Mesh& mesh, int point, const std::vector<int>& quads,
                                       const std::set<std::array<int, 2>>& joints) {
  DisjointSets joined(quads.size());
  std::map<int, std::vector<int>> beside;  // by other end: places in `quads`
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const auto& quad = mesh.quads[quads[i]];
    const int k = corner_at(quad, point);
    for (const int other : {quad[(k + 1) % 4], quad[(k + 3) % 4]})
      beside[other].push_back(static_cast<int>(i));
  }
  std::vector<std::map<int, int>> seen(quads.size());  // by place: how often each joint
  std::set<int> ends;
  for (const auto& [other, at] : beside) {
    const bool is_joint = joints.contains({std::min(point, other), std::max(point, other)});
    if (is_joint) ends.insert(other);
    for (const int i : at) {
      if (is_joint)
        ++seen[i][other];
      else
        joined.join(i, at[0]);
    }
  }
  if (ends.size() > 2)
    throw InputError(
        fmt::format("{} joints of plates meet at {}: expected joints that run on, or end at the boundary; "
                    "take out a plate there",
                    ends.size(), show_point(mesh.points[point])));
  const std::vector<int> place = joined.places();
  std::vector<std::vector<int>> parts;
  std::vector<std::map<int, int>> of_part;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const auto p = static_cast<std::size_t>(place[i]);
    if (p >= parts.size()) parts.resize(p + 1), of_part.resize(p + 1);
    parts[p].push_back(quads[i]);
    for (const auto& [other, n] : seen[i]) of_part[p][other] += n;
  }
  for (const auto& part : of_part)
    if (part.size() != ends.size() ||
        std::ranges::any_of(part, [](const auto& joint) { return joint.second != 1; }))
      throw InputError(
          fmt::format("a joint of plates ends at {} inside of a plate: expected joints that end at the "
                      "boundary; lengthen the rib to it",
                      show_point(mesh.points[point])));
  return parts;
}

}  // namespace

void split_joints(Section& section, ReadNotes* notes) {
  Mesh& mesh = section.mesh;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::set<std::array<int, 2>> joints;
  std::map<int, std::vector<int>> quads_at;  // by point on a joint
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    if (at.size() < 3) return;
    joints.insert({at[0].lo, at[0].hi});
    quads_at[at[0].lo], quads_at[at[0].hi];
  });
  if (joints.empty()) return;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : mesh.quads[q])
      if (const auto at = quads_at.find(v); at != quads_at.end()) at->second.push_back(static_cast<int>(q));
  for (const auto& [a, b] : joints) {
    JointEdge joint;
    for (const HalfEdge& side : sides_of_edge(sides, a, b))
      joint.branches.push_back({side.element, {a, b}, side.forward});
    std::ranges::stable_sort(joint.branches, {}, [&, a = a, b = b](const JointEdge::Branch& branch) {
      return angle_about(mesh, branch.quad, a, b);
    });
    section.joints.push_back(std::move(joint));
  }
  std::vector<std::array<int, 2>> line_at;  // quad and corner where each line begins; -1: on a joint
  for (const auto& [a, b] : mesh.lines) {
    const auto at = sides_of_edge(sides, a, b);
    line_at.push_back({at.size() > 2 ? -1 : at[0].element, corner_at(mesh.quads[at[0].element], a)});
  }
  std::map<std::array<int, 2>, int> copy_of;  // by quad and point
  for (const auto& [point, quads] : quads_at) {
    const auto parts = parts_at(mesh, point, quads, joints);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      int copy = point;
      if (p > 0) {
        copy = static_cast<int>(mesh.points.size());
        mesh.points.push_back(Vec3(mesh.points[point]));
        section.origin.push_back(point);
      }
      for (const int q : parts[p]) copy_of[{q, point}] = copy;
    }
  }
  for (JointEdge& joint : section.joints)
    for (auto& branch : joint.branches)
      for (int& end : branch.ends) end = copy_of.at({branch.quad, end});
  const std::vector<std::array<int, 4>> before = mesh.quads;
  for (const auto& [key, copy] : copy_of) mesh.quads[key[0]][corner_at(before[key[0]], key[1])] = copy;
  const std::size_t n_gone = keep_lines(mesh, [&](std::size_t l) {
    const auto [quad, corner] = line_at[l];
    if (quad < 0) return false;
    const bool is_forward = before[quad][(corner + 1) % 4] == mesh.lines[l][1];
    mesh.lines[l] = {mesh.quads[quad][corner], mesh.quads[quad][(corner + (is_forward ? 1 : 3)) % 4]};
    return true;
  });
  if (notes != nullptr && n_gone > 0)
    notes->push_back(fmt::format("{} lines on joints of plates were left out", n_gone));
}

namespace {

class JointFiller {
 public:
  JointFiller(const Section& section, LayeredPoints& layered)
      : section_(section),
        layered_(layered),
        n_(static_cast<int>(section.mesh.points.size())),
        half_(layered.n_layers / 2) {}

  void fill() {
    if (section_.joints.empty()) return;
    if (layered_.n_layers % 2 != 0)
      throw InputError(fmt::format("{} layers: expected an even number for the joint of plates at {}",
                                   layered_.n_layers,
                                   show_point(place_of(section_.joints[0].branches[0].ends[0]))));
    find_corners();
    move_points();
    for (const JointEdge& joint : section_.joints) add_cells(joint);
  }

 private:
  using Branch = JointEdge::Branch;

  Vec3 place_of(int point) const { return section_.mesh.points[point]; }
  int at(int point, int level) const { return level * n_ + point; }
  /// The outer level of a branch that looks to the next one, or to the previous one.
  int outer(const Branch& branch, bool to_next) const {
    return branch.is_forward == to_next ? layered_.n_layers : 0;
  }

  /// Joins the points of neighboring branches where their walls meet.
  void find_corners() {
    layered_.joints.same_as.resize(layered_.points.size());
    std::iota(layered_.joints.same_as.begin(), layered_.joints.same_as.end(), 0);
    std::map<int, int> partner;
    for (const JointEdge& joint : section_.joints)
      for (std::size_t i = 0; i < joint.branches.size(); ++i)
        for (const int end : {0, 1}) {
          const Branch &here = joint.branches[i], &next = joint.branches[(i + 1) % joint.branches.size()];
          const int a = at(here.ends[end], outer(here, true)), b = at(next.ends[end], outer(next, false));
          for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)})
            if (partner.emplace(p, q).first->second != q)
              throw InputError(
                  fmt::format("the plates at the joint at {} change their order along it: expected "
                              "plates that do not cross",
                              show_point(place_of(here.ends[end]))));
          layered_.joints.same_as[std::max(a, b)] = std::min(a, b);
        }
    for (const auto& [p, q] : partner) corners_.emplace(std::min(p, q), std::max(p, q));
  }

  /// Moves both outer levels to corners, and the levels in between along with them.
  void move_points() {
    std::map<int, std::vector<std::array<int, 2>>> around;  // by copy: quads and corners
    for (const JointEdge& joint : section_.joints)
      for (const Branch& branch : joint.branches)
        for (const int end : branch.ends) around[end];
    for (std::size_t q = 0; q < section_.mesh.quads.size(); ++q)
      for (int k = 0; k < 4; ++k)
        if (const auto found = around.find(section_.mesh.quads[q][k]); found != around.end())
          found->second.push_back({static_cast<int>(q), k});
    for (const auto& [p, q] : corners_) {
      std::vector<SidedCorner> walls;
      for (const int node : {p, q})
        for (const auto& [quad, corner] : around.at(node % n_))
          walls.push_back({quad, corner, node < n_ ? -1.0 : 1.0});
      const Vec3 from = place_of(p % n_);
      const Vec3 corner = from + layered_.thickness / 2 * offset_direction(section_.mesh, walls, from);
      layered_.points[p] = layered_.points[q] = corner;
    }
    for (const auto& [copy, quads] : around)
      for (int level = 1; level < layered_.n_layers; ++level) {
        const double share = layered_.shares[level];
        layered_.points[at(copy, level)] =
            (1 - share) * layered_.points[at(copy, 0)] + share * layered_.points[at(copy, layered_.n_layers)];
      }
  }

  int add_point(const Vec3& place, int point) {
    layered_.points.push_back(place);
    layered_.joints.origin.push_back(section_.original(point));
    return static_cast<int>(layered_.points.size()) - 1;
  }

  /// The nodes between two branches at an end of a joint. Rows run along the wall of `here`, from the corner
  /// to its middle; columns run along the wall of `next`.
  std::vector<int> grid(const Branch& here, const Branch& next, int end) {
    const int a = here.ends[end], b = next.ends[end];
    std::vector<int>& nodes = grids_[{a, b}];
    if (!nodes.empty()) return nodes;
    nodes.resize(static_cast<std::size_t>((half_ + 1) * (half_ + 1)));
    const auto node = [&](int s, int t) -> int& {
      return nodes[static_cast<std::size_t>(t * (half_ + 1) + s)];
    };
    if (const auto turned = grids_.find({b, a}); turned != grids_.end()) {  // of a joint that runs back
      for (int s = 0; s <= half_; ++s)
        for (int t = 0; t <= half_; ++t)
          node(s, t) = turned->second[static_cast<std::size_t>(s * (half_ + 1) + t)];
      return nodes;
    }
    const auto on_here = [&](int s) {
      return layered_.joints.same_as[at(a, std::abs(outer(here, true) - s))];
    };
    const auto on_next = [&](int t) {
      return layered_.joints.same_as[at(b, std::abs(outer(next, false) - t))];
    };
    for (int k = 0; k <= half_; ++k) node(k, 0) = on_here(k), node(0, k) = on_next(k);
    const std::vector<int>&right = spoke(a), &left = spoke(b);
    for (int k = 1; k <= half_; ++k) node(half_, k) = right[k], node(k, half_) = left[k];
    const auto point = [&](int s, int t) { return layered_.points[node(s, t)]; };
    for (int t = 1; t < half_; ++t)
      for (int s = 1; s < half_; ++s) {
        const double u = double(s) / half_, v = double(t) / half_;
        const Vec3 sides =
            (1 - v) * point(s, 0) + v * point(s, half_) + (1 - u) * point(0, t) + u * point(half_, t);
        const Vec3 corners = (1 - u) * (1 - v) * point(0, 0) + u * (1 - v) * point(half_, 0) +
                             u * v * point(half_, half_) + (1 - u) * v * point(0, half_);
        node(s, t) = add_point(sides - corners, a);
      }
    return nodes;
  }

  /// The nodes from the middle of a branch's wall to the center of the joint.
  const std::vector<int>& spoke(int copy) {
    std::vector<int>& nodes = spokes_[copy];
    if (!nodes.empty()) return nodes;
    const int middle = at(copy, half_), centre = centre_of(copy);
    const Vec3 from = layered_.points[middle], to = layered_.points[centre];
    nodes = {middle};
    for (int k = 1; k < half_; ++k) nodes.push_back(add_point(from + double(k) / half_ * (to - from), copy));
    nodes.push_back(centre);
    return nodes;
  }

  /// The mean of all corners.
  int centre_of(int copy) {
    const int point = section_.original(copy);
    const auto [found, is_new] = centres_.try_emplace(point, 0);
    if (!is_new) return found->second;
    Vec3 sum;
    int n = 0;
    for (const auto& [p, q] : corners_)
      if (section_.original(p % n_) == point) sum = sum + layered_.points[p], ++n;
    return found->second = add_point(1.0 / n * sum, copy);
  }

  void add_cells(const JointEdge& joint) {
    const std::vector<Branch>& branches = joint.branches;
    const int least = std::ranges::min(branches, {}, [&](const Branch& branch) {
                        return section_.mesh.quad_region[branch.quad];
                      }).quad;
    for (std::size_t i = 0; i < branches.size(); ++i) {
      const Branch &here = branches[i], &next = branches[(i + 1) % branches.size()];
      const std::vector<int> first = grid(here, next, 0), second = grid(here, next, 1);
      const auto face = [&](const std::vector<int>& nodes, int s, int t) {
        const int k = t * (half_ + 1) + s;
        return std::array{nodes[k], nodes[k + half_ + 1], nodes[k + half_ + 2], nodes[k + 1]};
      };
      for (int t = 0; t < half_; ++t)
        for (int s = 0; s < half_; ++s) {
          const auto [a, b, c, d] = face(first, s, t);
          const auto [e, f, g, h] = face(second, s, t);
          layered_.joints.cells.push_back({{a, b, c, d, e, f, g, h}, least});
          if (is_end(here.ends[0])) layered_.joints.ends.push_back({{d, c, b, a}, here.ends[0]});
          if (is_end(here.ends[1])) layered_.joints.ends.push_back({{e, f, g, h}, here.ends[1]});
        }
    }
  }

  /// Whether the joint ends at a point.
  bool is_end(int copy) {
    if (n_joints_.empty())
      for (const JointEdge& joint : section_.joints)
        for (const int end : joint.branches[0].ends) ++n_joints_[section_.original(end)];
    return n_joints_.at(section_.original(copy)) == 1;
  }

  const Section& section_;
  LayeredPoints& layered_;
  const int n_, half_;
  std::map<int, int> corners_;  ///< two points that meet, the lower one first
  std::map<std::array<int, 2>, std::vector<int>> grids_;
  std::map<int, std::vector<int>> spokes_;
  std::map<int, int> centres_, n_joints_;
};

}  // namespace

void fill_joints(const Section& section, LayeredPoints& layered) { JointFiller(section, layered).fill(); }

}  // namespace delquad
