#include "geometry/surface/orient_triangles.h"

#include <fmt/format.h>

#include "base/box.h"
#include "delquad/error.h"
#include "geometry/surface/surface_messages.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

struct Component {
  std::vector<int> triangles;
  bool closed = true;
  double volume = 0;  ///< that it encloses, negative when its triangles face inwards
  Box<Vec3> box;

  bool within_box_of(const Component& other) const {
    return box.low.x > other.box.low.x && box.low.y > other.box.low.y && box.low.z > other.box.low.z &&
           box.high.x < other.box.high.x && box.high.y < other.box.high.y && box.high.z < other.box.high.z;
  }
  double box_volume() const { return box.size().x * box.size().y * box.size().z; }
};

/// Collects the component of triangle `seed`; `turn` says for each of its triangles (-1 before) whether it
/// runs against the seed.
Component collect(const Mesh& mesh, const std::vector<int>& twin, int seed, std::vector<signed char>& turn,
                  const std::string& source) {
  Component component;
  turn[seed] = 0;
  component.triangles = {seed};
  for (size_t i = 0; i < component.triangles.size(); ++i) {
    const int t = component.triangles[i];
    for (int side = 3 * t; side < 3 * t + 3; ++side) {
      if (twin[side] < 0) {
        component.closed = false;
        continue;
      }
      const int u = twin[side] / 3;
      const bool against = side_start(mesh, side) == side_start(mesh, twin[side]);
      const signed char wanted = against ? 1 - turn[t] : turn[t];
      if (turn[u] < 0) {
        turn[u] = wanted;
        component.triangles.push_back(u);
      } else if (turn[u] != wanted) {
        throw InputError(
            fmt::format("{}: the surface has one side only, like a Moebius band (found at the edge from {} "
                        "to {}): expected two "
                        "sides",
                        source, show_point(mesh.points[side_start(mesh, side)]),
                        show_point(mesh.points[side_end(mesh, side)])));
      }
    }
  }
  return component;
}

void measure(const Mesh& mesh, const std::vector<signed char>& turn, Component& component) {
  const Vec3 origin = mesh.points[mesh.triangles[component.triangles[0]][0]];
  component.box = {origin, origin};
  for (const int t : component.triangles) {
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.points[mesh.triangles[t][k]];
      component.box.add(p[k]);
    }
    const double volume = dot(p[0] - origin, cross(p[1] - origin, p[2] - origin)) / 6;
    component.volume += turn[t] ? -volume : volume;
  }
}

void turn_over(const Component& component, std::vector<signed char>& turn) {
  for (const int t : component.triangles) turn[t] = 1 - turn[t];
}

}  // namespace

void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings) {
  const std::vector<int> twin = side_twins(mesh);
  std::vector<signed char> turn(mesh.triangles.size(), -1);
  std::vector<Component> closed;
  size_t largest = 0;
  int against = 0;
  Vec3 first;
  for (size_t seed = 0; seed < turn.size(); ++seed) {
    if (turn[seed] >= 0) continue;
    Component component = collect(mesh, twin, static_cast<int>(seed), turn, source);
    const auto turned = [&](int t) { return turn[t] == 1; };
    const auto& all = component.triangles;
    if (2 * std::count_if(all.begin(), all.end(), turned) > static_cast<long>(all.size())) {
      turn_over(component, turn);
    }
    const auto odd = std::find_if(all.begin(), all.end(), turned);
    if (odd != all.end() && against == 0) first = mesh.points[mesh.triangles[*odd][0]];
    against += static_cast<int>(std::count_if(all.begin(), all.end(), turned));
    if (!component.closed) continue;
    measure(mesh, turn, component);
    closed.push_back(std::move(component));
    if (closed.back().box_volume() > closed[largest].box_volume()) largest = closed.size() - 1;
  }
  int inwards = 0;
  for (const Component& component : closed) {
    if (component.volume >= 0 || component.within_box_of(closed[largest])) continue;
    turn_over(component, turn);
    ++inwards;
  }
  for (size_t t = 0; t < turn.size(); ++t) {
    if (turn[t] == 1) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  if (against > 0) {
    warnings.push_back(fmt::format("turned over {} against the neighbours' orientation (the first at {})",
                                   counted(against, "triangle"), show_point(first)));
  }
  if (inwards > 0) warnings.push_back("turned outwards " + counted(inwards, "closed surface"));
}

}  // namespace delquad
