// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "delquad/mesher.h"

namespace delquad::testing_support {

/// A planar model made loop by loop. Names of curves go around: fewer of them than curves repeat.
struct ModelMaker : PlanarModel {
  using Shape = std::shared_ptr<const Curve>;
  using Names = std::vector<std::string>;

  ModelMaker() { source = "test.toml"; }
  ModelMaker& loop(const std::vector<Shape>& shapes, const std::string& region = "",
                   const Names& names = {""}) {
    loops.push_back({{}, region, ""});
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      loops.back().curves.push_back(static_cast<int>(curves.size()));
      curve(shapes[i], names[i % names.size()]);
    }
    return *this;
  }
  /// Segments from corner to corner.
  ModelMaker& polygon(const std::vector<Vec2>& corners, const Names& names = {""},
                      const std::string& region = "") {
    std::vector<Shape> sides;
    for (std::size_t i = 0; i < corners.size(); ++i)
      sides.push_back(make_segment(corners[i], corners[(i + 1) % corners.size()]));
    return loop(sides, region, names);
  }
  ModelMaker& rectangle(Vec2 low, Vec2 high, const Names& names = {""}, const std::string& region = "") {
    return polygon({low, {high.x, low.y}, high, {low.x, high.y}}, names, region);
  }
  ModelMaker& circle(Vec2 centre, double radius, const std::string& name = "",
                     const std::string& region = "") {
    return loop({make_circle(centre, radius)}, region, {name});
  }
  /// In no loop.
  ModelMaker& curve(Shape shape, const std::string& name = "", bool is_crack = false) {
    curves.push_back({std::move(shape), name, "", is_crack});
    return *this;
  }
  /// A loop of curves that the model has already.
  ModelMaker& loop_of(std::vector<int> numbers, const std::string& region = "") {
    loops.push_back({std::move(numbers), region, ""});
    return *this;
  }
  ModelMaker& point(Vec2 at, const std::string& name) {
    points.push_back({at, name, ""});
    return *this;
  }
  MeshProblem problem(double size, std::vector<LayerSpec> layers = {}) const {
    MeshProblem problem;
    problem.model = *this;
    problem.size.field = make_constant_size(size);
    problem.layers = std::move(layers);
    return problem;
  }
};

}  // namespace delquad::testing_support
