// SPDX-License-Identifier: GPL-3.0-or-later
// Registers measures, costs, stages and fields that Python adds.
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "delquad/error.h"
#include "delquad/extend.h"
#include "program/python/arrays.h"
#include "program/python/problem.h"

namespace delquad::python {
namespace {

/// A Python function that any thread may call. It is never released, so it outlives the interpreter.
class Kept {
 public:
  /// `name` is for messages, such as "cost 'own'".
  Kept(const py::object& function, std::string name)
      : function_(function.inc_ref().ptr()), name_(std::move(name)) {}

  /// Calls use(function) with the GIL. Exceptions of the function and wrong results become an Error.
  template <class F>
  auto with(F&& use) const {
    const py::gil_scoped_acquire acquired;
    try {
      return use(py::reinterpret_borrow<py::object>(function_));
    } catch (const py::error_already_set& error) {
      const std::string text = error.what();
      throw Error(name_ + text.substr(0, text.find("\n\nAt:")));  // without the stack
    } catch (const InputError& error) {
      throw Error(name_ + error.what());
    }
  }

 private:
  py::handle function_;
  std::string name_;  ///< with a colon, or empty
};

/// Returns the values of a field at points.
template <class Value>
py::array_t<double> at_points(const std::vector<Vec2>& points, const Value& value) {
  py::array_t<double> array(static_cast<py::ssize_t>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) array.mutable_data()[i] = value(points[i]);
  return array;
}

void add_python_metric(const std::string& key, const py::object& function, const std::string& title,
                       const std::string& unit, const std::string& better, const std::optional<double>& worst,
                       const std::string& source, int digits) {
  const std::map<std::string, Better> ways = {
      {"higher", Better::kHigher}, {"lower", Better::kLower}, {"neither", Better::kNeither}};
  const auto way = ways.find(better);
  if (way == ways.end())
    throw InputError("better: '" + better + "': expected 'higher', 'lower' or 'neither'");
  add_metric(
      {key, title.empty() ? key : title, unit, way->second, worst.value_or(std::nan("")), source, digits},
      [kept = Kept(function, "")](const MetricInput& in) {
        return kept.with([&](const py::object& measure) {
          using namespace py::literals;
          py::object size = py::none();
          if (in.size != nullptr) {
            py::array_t<double> at(static_cast<py::ssize_t>(in.mesh.points.size()));
            int hint = -1;
            for (std::size_t i = 0; i < in.mesh.points.size(); ++i)
              at.mutable_data()[i] = in.size->at(in.mesh.points[i], hint);
            size = std::move(at);
          }
          const auto copy = [](const Mesh* mesh) {
            return mesh == nullptr ? py::object(py::none()) : py::cast(std::make_shared<Mesh>(*mesh));
          };
          return measure(copy(&in.mesh), "size"_a = size, "problem"_a = in.problem, "word"_a = in.pipeline,
                         "surface"_a = copy(in.surface))
              .cast<double>();
        });
      });
}

void add_python_cost(const std::string& name, const py::object& function) {
  add_merge_cost(name, [kept = Kept(function, "cost '" + name + "': ")](const Options&) -> MergeCost {
    return [&kept](std::span<const MergedQuad> quads, std::span<double> cost) {
      kept.with([&](const py::object& cost_of) {
        const auto n = static_cast<py::ssize_t>(quads.size());
        py::array_t<double> corners({n, py::ssize_t{4}, py::ssize_t{2}}), theta(n), size(n);
        for (py::ssize_t i = 0; i < n; ++i) {
          for (py::ssize_t k = 0; k < 4; ++k) {
            corners.mutable_at(i, k, 0) = quads[i].corners[k].x;
            corners.mutable_at(i, k, 1) = quads[i].corners[k].y;
          }
          theta.mutable_at(i) = quads[i].cross.angle();
          size.mutable_at(i) = quads[i].delta;
        }
        read_values(cost_of(corners, theta, size), cost.data(), cost.size(), "its result");
      });
    };
  });
}

void add_python_stage(const std::string& letter, const py::object& function, const std::string& name) {
  if (letter.size() != 1)
    throw std::invalid_argument("letter '" + letter + "': expected a capital from A to Z");
  const auto run = [kept = Kept(function, "")](const StageInput& in, PatchMesh& patch, StageLog&) {
    QuadPatch& mesh = patch.quads;
    if (!mesh.triangles.empty()) throw Error("a patch has triangles: this stage takes quads only");
    kept.with([&](const py::object& edit) {
      const auto theta = at_points(mesh.points, [&](Vec2 u) {
        int hint = -1;
        return in.cross.at(u, hint).angle();
      });
      const auto size = at_points(mesh.points, [&](Vec2 u) {
        int hint = -1;
        return in.size.at(u, hint);
      });
      const py::array_t<int> quads({static_cast<py::ssize_t>(mesh.quads.size()), py::ssize_t{4}},
                                   mesh.quads.empty() ? nullptr : mesh.quads[0].data());
      const auto made =
          py::tuple(edit(points_for_python<Vec2>(mesh.points), quads, mesh.n_boundary, theta, size));
      if (made.size() != 2) throw Error("the result of the stage: expected points and quads");
      std::vector<Vec2> points = read_plane_points(made[0], "the stage's points");
      mesh.quads = read_elements<4>(made[1], "the stage's quads");
      mesh.points = std::move(points);
    });
  };
  add_stage({letter[0], name, PatchForm::kQuads, PatchForm::kQuads, run});
}

/// Adapts a Python function to SizeFunction or CrossFunction.
template <class V>
auto as_batch(const py::object& function, const std::string& name) {
  return [kept = Kept(function, name + ": ")](std::span<const V> points, std::span<double> values) {
    if (points.empty()) return;
    kept.with([&](const py::object& field) {
      read_values(field(points_for_python(points)), values.data(), values.size(), "its result");
    });
  };
}

}  // namespace

void define_parts(py::module_& m) {
  using py::arg;
  m.def("add_metric", &add_python_metric, arg("key"), arg("function"), arg("title"), arg("unit"),
        arg("better"), arg("worst"), arg("source"), arg("digits"));
  m.def("add_merge_cost", &add_python_cost, arg("name"), arg("function"));
  m.def("add_stage", &add_python_stage, arg("letter"), arg("function"), arg("name"));
  m.def("add_size", [](const std::string& name, const py::object& function) {
    add_size(name, [batch = as_batch<Vec3>(function, "size '" + name + "'")](const Options&, SizeSpec& size) {
      size.function = batch;
    });
  });
  m.def("add_cross", [](const std::string& name, const py::object& function) {
    add_cross(name,
              [batch = as_batch<Vec2>(function, "cross '" + name + "'")](const Options&, CrossSpec& cross) {
                cross.kind = CrossKind::kField;
                cross.function = batch;
              });
  });
}

}  // namespace delquad::python
