// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <sstream>
#include <variant>

#include "base/located.h"
#include "geometry/cad/example_models.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/planar/sampled_curve.h"
#include "program/python/arrays.h"
#include "program/python/problem.h"

namespace delquad::python {

namespace {

struct Loop {
  std::vector<ModelCurve> curves;
  std::string region;
};

ModelHandle handle_of(Model model, const char* name) {
  ModelHandle handle;
  handle.problem.name = name;
  handle.problem.where = name;
  handle.problem.model = std::move(model);
  return handle;
}

ModelHandle make_polygons(const std::vector<py::object>& loops) {
  std::vector<std::vector<Vec2>> points;
  for (std::size_t i = 0; i < loops.size(); ++i)
    points.push_back(read_plane_points(loops[i], fmt::format("polygon {}", i + 1)));
  return handle_of(polygons(points), "polygons");
}

/// A curve that stands in two loops is one curve of both.
ModelHandle make_planar(const std::vector<Loop>& loops,
                        const std::vector<std::variant<ModelCurve, ModelPoint>>& embed) {
  PlanarModel model{"planar model", {}, {}};
  for (const Loop& loop : loops) {
    ModelLoop& target = model.loops.emplace_back();
    target.region = loop.region;
    target.where = fmt::format("loop {}", model.loops.size());
    for (const ModelCurve& curve : loop.curves) {
      const auto found = std::ranges::find(model.curves, curve.shape, &ModelCurve::shape);
      target.curves.push_back(static_cast<int>(found - model.curves.begin()));
      if (found == model.curves.end()) model.curves.push_back(curve);
    }
  }
  for (const auto& embedded : embed) {
    if (const auto* curve = std::get_if<ModelCurve>(&embedded))
      model.curves.push_back(*curve);
    else
      model.points.push_back(std::get<ModelPoint>(embedded));
  }
  return handle_of(std::move(model), "planar model");
}

std::vector<Entity> default_entities(const std::vector<int>& indices) {
  std::vector<Entity> entities;
  const int n = indices.empty() ? 0 : *std::ranges::max_element(indices) + 1;
  for (int i = 0; i < n; ++i) entities.push_back({i + 1, {}});
  return entities;
}

/// Returns the entity of each element; without `given` the first one.
std::vector<int> entities_of(const py::object& given, std::size_t n, const std::string& what) {
  return given.is_none() ? std::vector<int>(n, 0) : read_integers(given, what);
}

ModelHandle make_lines(const py::object& points, const py::object& lines, const py::object& curve) {
  LineModel model;
  model.mesh.points = read_points(points, "lines: points");
  model.mesh.lines = read_elements<2>(lines, "lines: lines");
  model.mesh.line_curve = entities_of(curve, model.mesh.lines.size(), "lines: line_curve");
  model.mesh.curves = default_entities(model.mesh.line_curve);
  require_readable(model.mesh, model.source);
  return handle_of(std::move(model), "lines");
}

ModelHandle make_triangles(const py::object& points, const py::object& triangles, const py::object& region) {
  TriangleModel model;
  model.mesh.points = read_points(points, "triangles: points");
  model.mesh.triangles = read_elements<3>(triangles, "triangles: triangles");
  model.mesh.triangle_region = entities_of(region, model.mesh.triangles.size(), "triangles: triangle_region");
  model.mesh.regions = default_entities(model.mesh.triangle_region);
  require_readable(model.mesh, model.source);
  return handle_of(std::move(model), "triangles");
}

/// Returns the triangles and quads of a mesh or, if it has none, its lines.
ModelHandle from_mesh(const Mesh& mesh) {
  if (mesh.triangles.empty() && mesh.quads.empty()) return handle_of(LineModel{mesh}, "lines");
  return handle_of(TriangleModel{mesh}, "triangles");
}

ModelCurve sampled_curve(const py::function& function, double t0, double t1, const std::string& name) {
  const auto points = [&](std::span<const double> t, std::span<Vec2> target) {
    const py::object returned = function(py::array_t<double>(static_cast<py::ssize_t>(t.size()), t.data()));
    const std::vector<Vec2> read = read_plane_points(returned, "the result of the curve's function");
    if (read.size() != t.size())
      refuse("the result of the curve's function: expected {} points, one for each parameter, got {}",
             t.size(), read.size());
    std::ranges::copy(read, target.begin());
  };
  return {make_sampled_curve(points, t0, t1), name, ""};
}

void define_curves(py::module_& m) {
  using py::arg;
  py::class_<ModelCurve>(m, "Curve", "A curve of the plane, from segment(), arc(), ...")
      .def_readonly("name", &ModelCurve::name)
      .def(
          "point",
          [](const ModelCurve& curve, double t) {
            const Vec2 p = curve.shape->point(t);
            return std::pair(p.x, p.y);
          },
          arg("t"), "Returns (x, y) at t in [0, 1].");
  m.def(
      "segment",
      [](const py::object& a, const py::object& b, const std::string& name) {
        return ModelCurve{
            make_segment(read_vec2(a, "the segment's start"), read_vec2(b, "the segment's end")), name, ""};
      },
      arg("a"), arg("b"), arg("name") = "", "Returns the straight line from a to b.");
  m.def(
      "polyline",
      [](const py::object& points, const std::string& name) {
        return ModelCurve{make_polyline(read_plane_points(points, "polyline")), name, ""};
      },
      arg("points"), arg("name") = "",
      "Returns a polyline through points of shape (n, 2), n >= 2. Every point gets a node.");
  m.def(
      "spline",
      [](const py::object& points, const std::string& name, double corner) {
        return ModelCurve{make_spline(read_plane_points(points, "spline"), corner), name, ""};
      },
      arg("points"), arg("name") = "", arg("corner") = std::numbers::pi / 3,
      "Returns the cubic spline through points of shape (n, 2), with corners where chords turn by more than "
      "`corner` (radians). It is closed if the last point equals the first.");
  m.def(
      "arc",
      [](const py::object& centre, double radius, double angle0, double angle1, const std::string& name) {
        return ModelCurve{make_arc(read_vec2(centre, "the arc's centre"), radius, angle0, angle1), name, ""};
      },
      arg("centre"), arg("radius"), arg("angle0"), arg("angle1"), arg("name") = "",
      "Returns an arc of at most one turn, counterclockwise if angle1 > angle0; angles are in radians.");
  m.def(
      "circle",
      [](const py::object& centre, double radius, const std::string& name) {
        return ModelCurve{make_circle(read_vec2(centre, "the circle's centre"), radius), name, ""};
      },
      arg("centre"), arg("radius"), arg("name") = "", "Returns a circle, which begins at angle 0.");
  m.def("curve", &sampled_curve, arg("function"), arg("t0"), arg("t1"), arg("name") = "",
        "Returns a curve for t from t0 to t1. function(t) of an array of parameters returns points of shape "
        "(n, 2).");
  m.def(
      "crack",
      [](ModelCurve curve) {
        curve.is_crack = true;
        return curve;
      },
      arg("curve"),
      "Returns the same curve as a crack, at which the mesh opens: nodes are doubled, except at inner tips.");
  py::class_<ModelPoint>(m, "ModelPoint", "A point that becomes a node, see point().");
  m.def(
      "point",
      [](const py::object& at, const std::string& name) {
        return ModelPoint{read_vec2(at, "the point"), name, ""};
      },
      arg("at"), arg("name") = "", "Returns a point that becomes a node, for planar().");
  py::class_<Loop>(m, "Loop", "A closed chain of curves, see loop().");
  m.def(
      "loop",
      [](std::vector<ModelCurve> curves, const std::string& region) {
        return Loop{std::move(curves), region};
      },
      arg("curves"), arg("region") = "",
      "Returns a loop of curves in any order, with a name for the region inside. Loops inside others without "
      "a name are holes.");
}

}  // namespace

ModelHandle read_model(const std::string& path) {
  const py::gil_scoped_release released;
  return {read_model_file(path)};
}

void define_models(py::module_& m) {
  using py::arg;
  py::class_<ModelHandle>(m, "Model", "A model, from planar(), cad() and similar functions.")
      .def_property_readonly("name", [](const ModelHandle& model) { return model.problem.name; })
      .def("__repr__",
           [](const ModelHandle& model) { return "<delquad.Model '" + model.problem.name + "'>"; });
  define_curves(m);
  m.def("polygons", &make_polygons, arg("polygons"));
  m.def("planar", &make_planar, arg("loops"), arg("embed"));
  m.def("lines", &make_lines, arg("points"), arg("lines"), arg("line_curve") = py::none(),
        "Returns a planar domain that lines bound: (n, 2) indices of points, each of which becomes an edge. "
        "line_curve: a number for each line.");
  m.def("triangles", &make_triangles, arg("points"), arg("triangles"), arg("triangle_region") = py::none(),
        "Returns a surface of triangles: (n, 3) indices of points of shape (m, 3). triangle_region: a number "
        "for each triangle.");
  m.def("from_mesh", &from_mesh, arg("mesh"));
  m.def(
      "given_mesh", [](const Mesh& mesh) { return handle_of(GivenMesh{mesh}, "mesh"); }, arg("mesh"));
  m.def(
      "example", [](const std::string& name) { return handle_of(ExampleModel{name}, "example"); },
      arg("name"));
  m.def(
      "example_step",
      [](const std::string& name) {
        std::ostringstream out;
        write_example(name, CadFormat::kStep, out);
        return py::bytes(out.str());
      },
      arg("name"), "Returns the bytes of the STEP file of an example.");
  m.def("examples", [] {
    py::dict all;
    for (const Example& example : example_models()) all[py::str(example.name)] = example.description;
    return all;
  });
  m.def(
      "cad",
      [](const py::bytes& bytes) {
        return handle_of(CadModel{{}, bytes}, "CAD model");
      },
      arg("bytes"));
  m.def(
      "set_cad_worker", [](const std::string& path) { set_cad_worker(path); }, arg("path"));
  m.def("read_model", &read_model, arg("path"));
}

}  // namespace delquad::python
