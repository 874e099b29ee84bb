#include <fmt/format.h>

#include "base/located.h"
#include "delquad/model.h"

namespace delquad {

PlanarModel polygons(const std::vector<std::vector<Vec2>>& loops) {
  PlanarModel model{"polygons", {}, {}};
  if (loops.empty()) throw InputError("polygons: there are none");
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::string name = fmt::format("polygon {}", i + 1);
    std::vector<Vec2> corners = loops[i];
    if (corners.size() < 3)
      throw InputError(fmt::format("{}: {} corners: at least three were expected", name, corners.size()));
    if (corners.front() == corners.back())
      throw InputError(
          fmt::format("{}: its last corner, ({}, {}), is its first one again: it closes by itself", name,
                      corners[0].x, corners[0].y));
    corners.push_back(corners[0]);
    model.curves.push_back({located(name, [&] { return make_polyline(corners); }), "", name});
    model.loops.push_back({{static_cast<int>(i)}, "", name});
  }
  return model;
}

}  // namespace delquad
