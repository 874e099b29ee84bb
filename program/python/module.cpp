// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "base/context.h"
#include "base/located.h"
#include "base/text.h"
#include "delquad/hexahedra.h"
#include "geometry/mesh/check_mesh.h"
#include "io/cases/case_file.h"
#include "io/cases/case_keys.h"
#include "io/cases/read_described.h"
#include "io/mesh_formats.h"
#include "program/python/arrays.h"
#include "program/python/problem.h"

namespace delquad::python {

namespace {

using py::arg;

std::vector<Entity> entities_of(const std::vector<std::pair<int, std::vector<std::string>>>& list) {
  std::vector<Entity> entities;
  for (const auto& [tag, names] : list) entities.push_back({tag, names});
  return entities;
}

/// Returns a list of the mesh as a property: a view that keeps the mesh alive.
template <class List>
auto view_of(List Mesh::*member) {
  return [member](const py::object& self) { return view(self.cast<const Mesh&>().*member, self); };
}

/// Adds a property of (tag, names).
template <class Class>
void add_entities(Class& c, const char* name, std::vector<Entity> Mesh::*member) {
  c.def_property_readonly(
      name, [member](const typename Class::type& self) { return list_of(self.*member); }, "(tag, names)");
}

Mesh make_mesh(const py::object& points, const py::object& lines, const py::object& line_curve,
               const py::object& triangles, const py::object& triangle_region, const py::object& quads,
               const py::object& quad_region,
               const std::vector<std::pair<int, std::vector<std::string>>>& curves,
               const std::vector<std::pair<int, std::vector<std::string>>>& regions) {
  Mesh mesh;
  mesh.points = read_points(points, "points");
  mesh.lines = read_elements<2>(lines, "lines");
  mesh.line_curve = read_integers(line_curve, "line_curve");
  mesh.triangles = read_elements<3>(triangles, "triangles");
  mesh.triangle_region = read_integers(triangle_region, "triangle_region");
  mesh.quads = read_elements<4>(quads, "quads");
  mesh.quad_region = read_integers(quad_region, "quad_region");
  mesh.curves = entities_of(curves);
  mesh.regions = entities_of(regions);
  require_readable(mesh, "mesh");
  return mesh;
}

void write(const Mesh& mesh, const std::string& path, bool binary, bool triangles,
           const std::string& element) {
  const py::gil_scoped_release released;
  write_mesh(path, mesh, {.binary = binary, .element = element, .triangles = triangles});
}

Mesh read(const std::string& path) {
  const py::gil_scoped_release released;
  return read_mesh(path);
}

/// Returns the extensions of files to write or to read, as in "delquad formats".
std::vector<std::string> extensions(bool written) {
  std::vector<std::string> all;
  for (const MeshFormat& format : mesh_formats())
    if (written ? can_write(format) : format.read != nullptr)
      all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  return all;
}

/// Returns (image, master, nodes of shape (n, 2)); each row has a node and the node whose image it is.
py::tuple pair_of(int image, int master, const std::vector<std::array<int, 2>>& nodes) {
  const auto n = static_cast<py::ssize_t>(nodes.size());
  py::array_t<int> array({n, py::ssize_t{2}});
  for (py::ssize_t i = 0; i < n; ++i)
    for (const py::ssize_t k : {0, 1}) array.mutable_at(i, k) = nodes[i][k];
  return py::make_tuple(image, master, array);
}

py::list periodic_of(const Mesh& mesh) {
  py::list pairs;
  for (const PeriodicNodes& pair : mesh.periodic) pairs.append(pair_of(pair.curve, pair.master, pair.nodes));
  return pairs;
}

py::list periodic_faces_of(const Mesh& mesh) {
  py::list pairs;
  for (const PeriodicFaces& pair : mesh.periodic_faces)
    pairs.append(pair_of(pair.face, pair.master, pair.nodes));
  return pairs;
}

Mesh extruded(const Mesh& mesh, int layers, double growth, const std::map<std::string, double>& heights,
              int threads, double time_limit, const py::object& along, const py::object& point,
              const py::object& axis, double degrees, const py::object& curve, const py::object& thickness,
              bool both_sides) {
  const auto path = [&]() -> SweepPath {
    if (!along.is_none()) return AlongVector{read_vec3(along, "along")};
    if (!point.is_none())
      return AroundAxis{read_vec3(point, "around: the point"), read_vec3(axis, "around: the axis"), degrees};
    if (!curve.is_none()) return AlongCurve{read_points(curve, "curve")};
    return AlongNormals{thickness.cast<double>(), both_sides};
  }();
  Mesh result;
  CallingThread().run([&](const std::stop_token& stop) {
    const RunScope scope({.threads = threads, .cancel = stop, .seconds = time_limit});
    result = extrude(mesh, path, {.number = layers, .growth = growth, .heights = heights});
  });
  return result;
}

LayerSpec volume_layers(const std::tuple<double, double, int>& layers, std::vector<std::string> on) {
  const auto [first, growth, number] = layers;
  return {.on = std::move(on), .first = first, .growth = growth, .number = number, .where = "layers"};
}

/// Returns layers_beside() as the keys of a model file; none: no layers are needed there.
py::object rows_beside(const Mesh& skin, const std::tuple<double, double, int>& layers,
                       const std::vector<std::string>& on) {
  const LayerSpec beside = layers_beside(volume_layers(layers, on), skin);
  if (beside.on.empty()) return py::none();
  return py::dict(arg("on") = beside.on, arg("into") = beside.into, arg("first") = beside.first,
                  arg("growth") = beside.growth, arg("number") = beside.number, arg("fan") = beside.fan);
}

/// Returns the mesh and the notes on it.
std::pair<Mesh, ReadNotes> filled(const Mesh& skin, const std::string& cells, const std::string& strategy,
                                  long long max_elements, int threads, double time_limit,
                                  const std::optional<std::tuple<double, double, int>>& layers,
                                  const std::vector<std::string>& layers_on) {
  VolumeOptions options{volume_cells(cells), max_elements, strategy};
  if (layers) options.layers = volume_layers(*layers, layers_on);
  std::pair<Mesh, ReadNotes> result;
  CallingThread().run([&](const std::stop_token& stop) {
    const RunScope scope({.threads = threads, .cancel = stop, .seconds = time_limit});
    result.first = fill_skin(skin, options, &result.second);
  });
  return result;
}

void define_mesh(py::module_& m) {
  py::class_<Mesh, std::shared_ptr<Mesh>> c(m, "Mesh", "Points and elements; indices count from 0.");
  add_entities(c, "curves", &Mesh::curves);
  add_entities(c, "regions", &Mesh::regions);
  add_entities(c, "volumes", &Mesh::volumes);
  add_entities(c, "faces", &Mesh::regions);
  c.def(py::init(&make_mesh), arg("points"), arg("lines"), arg("line_curve"), arg("triangles"),
        arg("triangle_region"), arg("quads"), arg("quad_region"), arg("curves"), arg("regions"))
      .def_property_readonly("points", view_of(&Mesh::points), "(n, 3) coordinates")
      .def_property_readonly("lines", view_of(&Mesh::lines), "(n, 2) indices of points: edges on curves")
      .def_property_readonly("triangles", view_of(&Mesh::triangles), "(n, 3) indices of points")
      .def_property_readonly("quads", view_of(&Mesh::quads), "(n, 4) indices of points")
      .def_property_readonly("line_curve", view_of(&Mesh::line_curve), "index into curves for each line")
      .def_property_readonly("triangle_region", view_of(&Mesh::triangle_region),
                             "index into regions for each triangle")
      .def_property_readonly("quad_region", view_of(&Mesh::quad_region), "index into regions for each quad")
      .def_property_readonly("thickness", view_of(&Mesh::thickness),
                             "of the shell, for each triangle, then each quad; empty: not known")
      .def_property_readonly("quad_face", view_of(&Mesh::quad_region), "the same beside cells")
      .def_property_readonly("hexahedra", view_of(&Mesh::hexahedra), "(n, 8) indices of points")
      .def_property_readonly("prisms", view_of(&Mesh::prisms), "(n, 6) indices of points")
      .def_property_readonly("pyramids", view_of(&Mesh::pyramids), "(n, 5) indices of points")
      .def_property_readonly("tetrahedra", view_of(&Mesh::tetrahedra), "(n, 4) indices of points")
      .def_property_readonly("hex_volume", view_of(&Mesh::hex_volume),
                             "index into volumes for each hexahedron")
      .def_property_readonly("prism_volume", view_of(&Mesh::prism_volume), "the same for prisms")
      .def_property_readonly("pyramid_volume", view_of(&Mesh::pyramid_volume), "the same for pyramids")
      .def_property_readonly("tet_volume", view_of(&Mesh::tet_volume), "the same for tetrahedra")
      .def_property_readonly(
          "volume", [](const Mesh& self) { return measure(self).volume; }, "of all cells")
      .def_property_readonly(
          "scaled_jacobian",
          [](const Mesh& self) {
            const std::vector<double> values = measure(self).jacobian;
            return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
          },
          "the least of each hexahedron, prism, pyramid and tetrahedron")
      .def_property_readonly("periodic", &periodic_of,
                             "(index of a curve, index of the master curve, (n, 2) pairs of nodes)")
      .def_property_readonly("periodic_faces", &periodic_faces_of,
                             "(index of a region, index of the master region, (n, 2) pairs of nodes)")
      .def_readonly("order", &Mesh::order, "of the elements, 1 to 4; lines and quads are their corners")
      .def_readonly("unit", &Mesh::unit, "of lengths; empty: not known")
      .def("_write_file", &write);
  m.def("read_mesh", &read, arg("path"));
  m.def("extrude", &extruded);
  m.def("fill_skin", &filled);
  m.def("rows_beside", &rows_beside);
  m.def("_extensions", &extensions, arg("written"));
}

py::dict dict_of(const Summaries& summaries) {
  py::dict all;
  for (const SummaryStep& step : summaries.steps()) {
    py::dict fields;
    for (const SummaryField& field : step.fields)
      fields[py::str(field.key)] =
          std::visit([](const auto& value) -> py::object { return py::cast(value); }, field.value);
    all[py::str(step.name)] = fields;
  }
  return all;
}

py::dict dict_of(const StepTimes& times) {
  py::dict all;
  for (const auto& [step, time] : times) all[py::str(step)] = time.seconds;
  return all;
}

py::object dict_of(const CriteriaReport& report) {
  using namespace py::literals;
  py::list limits;
  for (const CriterionResult& r : report.results)
    limits.append(py::dict("criterion"_a = r.limit.key, "limit"_a = r.limit.value,
                           "in_sizes"_a = r.limit.in_sizes, "on"_a = r.limit.on, "failing"_a = r.failing,
                           "worst"_a = r.worst, "at"_a = py::make_tuple(r.at.at.x, r.at.at.y, r.at.at.z),
                           "cause"_a = r.cause));
  py::list cures;
  for (const Cure& c : report.cures)
    cures.append(py::dict("cause"_a = c.cause, "key"_a = c.key, "value"_a = c.value, "count"_a = c.count));
  return py::dict("name"_a = report.name, "elements"_a = report.elements, "failing"_a = report.failing,
                  "limits"_a = limits, "causes"_a = report.causes, "why"_a = report.why, "cures"_a = cures,
                  "critical_step"_a = report.critical_step, "estimated_step"_a = report.estimated_step,
                  "step_of_squares"_a = report.step_of_squares);
}

py::object judged(const Mesh& mesh, const Criteria& criteria, const std::optional<double>& size) {
  if (!size) return dict_of(judge(mesh, criteria));
  const auto constant = located("size", [&] { return make_constant_size(*size); });
  return dict_of(judge(mesh, criteria, constant.get()));
}

/// Keys of model files: each has its keyword, for messages, and a line of TOML.
using KeyLines = std::vector<std::pair<std::string, std::string>>;

void set_keys(const KeyLines& lines, Case& c) {
  const TomlTable table = TomlTable::of_options(lines);
  table.require_known(case_keys());
  read_case_keys(table, c);
}

/// Returns (keyword, key of model files, its JSON Schema) for all keys of a problem.
std::vector<std::array<std::string, 3>> keywords() {
  std::vector<std::array<std::string, 3>> all;
  std::set<std::string> of_problems;
  for (const TomlKey& key : keys_of<MeshProblem>()) of_problems.insert(key.name);
  const auto add = [&](const TomlKeys& keys, const std::string& prefix, const auto& is_keyword) {
    const auto properties = schema_of(keys)["properties"];
    for (const TomlKey& key : keys)
      if (is_keyword(key.name))
        all.push_back({key.keyword != nullptr ? key.keyword : key.name, prefix + key.name,
                       properties[key.name].dump()});
  };
  const auto any = [](const std::string&) { return true; };
  const TomlKeys keys = case_keys();
  for (const TomlKey& key : keys)
    if (key.name == "size" || key.name == "surface" || key.name == "limits")
      add(key.table(), key.name + ".", any);
  add(keys, "", [&](const std::string& name) {
    return of_problems.contains(name) && name != "size" && name != "surface";
  });
  return all;
}

void define_criteria(py::module_& m) {
  m.def("keywords", &keywords);
  py::class_<Criteria>(m, "Criteria", "Limits by which elements are judged.")
      .def(py::init([](const KeyLines& lines) {
        Case c;
        set_keys(lines, c);
        return c.criteria;
      }));
  m.def("judge", &judged, arg("mesh"), arg("criteria"), arg("size"));
}

void define_result(py::module_& m) {
  py::class_<Result, Mesh, std::shared_ptr<Result>>(m, "Result", "A mesh and its report.")
      .def_property_readonly("metrics", [](const Result& r) { return r.rest.metrics.values; })
      .def_property_readonly(
          "valences", [](const Result& r) { return r.rest.metrics.valences; },
          "interior points by number of elements around them")
      .def_property_readonly("summaries", [](const Result& r) { return dict_of(r.rest.log.summaries); })
      .def_property_readonly(
          "seconds", [](const Result& r) { return dict_of(r.rest.log.times); },
          "wall-clock time by step, added up over parallel patches")
      .def_property_readonly("wall_seconds", [](const Result& r) { return r.rest.seconds; })
      .def_property_readonly("expected_quads", [](const Result& r) { return r.expected_quads; })
      .def_property_readonly("warnings",
                             [](const Result& r) {
                               std::vector<std::string> texts;
                               for (const Warning& warning : r.rest.warnings) texts.push_back(warning.text);
                               return texts;
                             })
      .def_property_readonly(
          "failures",
          [](const Result& r) {
            std::vector<std::pair<int, std::string>> failures;
            for (const FaceFailure& failure : r.rest.failures)
              failures.emplace_back(failure.face, failure.reason);
            return failures;
          },
          "(index into regions, reason) of faces that were left out; index -1 for unreadable parts of a file")
      .def_property_readonly(
          "failed_metrics", [](const Result& r) { return r.rest.metrics.failures; },
          "why a measure of add_metric() is nan, by key")
      .def_property_readonly("sound", [](const Result& r) { return r.rest.soundness.accepted(); })
      .def_property_readonly(
          "unsound",
          [](const Result& r) {
            std::vector<std::string> reasons = r.rest.soundness.reasons;
            for (const std::string& beyond : r.rest.soundness.beyond) reasons.push_back(beyond);
            return reasons;
          },
          "reasons; empty if it is sound")
      .def_property_readonly(
          "beyond_limits", [](const Result& r) { return r.rest.soundness.beyond; },
          "elements beyond min_angle, max_aspect and strict criteria, in words")
      .def_property_readonly(
          "criteria",
          [](const Result& r) -> py::object {
            return r.rest.criteria ? dict_of(*r.rest.criteria) : py::none();
          },
          "result of the criteria, see judge(); None without criteria")
      .def("_complaint", [](const Result& r) { return r.rest.soundness.complaint(); });
}

/// A problem that Python fills in.
struct Problem : ModelHandle {
  explicit Problem(const ModelHandle& model) : ModelHandle(model) {}
  Callbacks callbacks{py::none(), py::none(), py::none(), py::none()};

  /// Removes a field of the model's file.
  void clear(const std::string& field) {
    if (field == "size") problem.size = {};
    if (field == "cross") problem.cross = {};
    if (field == "metric") problem.metric = {};
  }
  void set_function(const std::string& field, py::object function) {
    clear(field);
    if (field == "cross") problem.cross.kind = CrossKind::kField;
    (field == "size"    ? callbacks.size
     : field == "cross" ? callbacks.cross
                        : callbacks.metric) = std::move(function);
  }
  /// Sets values at the points of a mesh.
  void set_nodal(const std::string& field, const Mesh& mesh, const py::object& values) {
    clear(field);
    located(field, [&] {
      if (field == "size") {
        problem.size.field = make_nodal_size(mesh, read_numbers(values, "values"));
      } else if (field == "cross") {
        problem.cross.kind = CrossKind::kField;
        problem.cross.field = make_nodal_cross(mesh, read_numbers(values, "values"));
      } else if (const auto array = py::array::ensure(values);
                 array && array.ndim() == 2 && array.shape(1) == 6) {
        problem.metric.in_space = make_nodal_space_metric(mesh, read_tensors(values, "the values"));
      } else {
        std::vector<Tensor2> metric;
        for (const Vec3& m : read_points(values, "the values")) metric.push_back({m.x, m.y, m.z});
        problem.metric.function = make_nodal_metric(mesh, std::move(metric));
      }
    });
  }
};

void define_problem(py::module_& m) {
  py::class_<Problem> c(m, "Problem", "A model with all options of its mesh.");
  c.def(py::init<const ModelHandle&>());
  c.def("clear", &Problem::clear)
      .def("set_function", &Problem::set_function)
      .def("set_nodal", &Problem::set_nodal)
      .def("embed",
           [](Problem& p, const py::object& points, const std::string& name, bool is_crack) {
             p.problem.surface.embed.push_back(
                 {read_points(points, "embed: points"), name, "embed", is_crack});
           })
      .def("set",
           [](Problem& p, const KeyLines& lines) {
             Case keys;
             static_cast<MeshProblem&>(keys) = p.problem;
             set_keys(lines, keys);
             p.problem = std::move(keys);
           })
      .def("name", [](Problem& p, const std::string& name) { p.problem.name = name; })
      .def("max_elements", [](Problem& p, long long n) { p.problem.max_elements = n; })
      .def("keep_going", [](Problem& p, bool yes) { p.problem.keep_going = yes; })
      .def("progress", [](Problem& p, py::object function) { p.callbacks.progress = std::move(function); })
      // Python throws UnsoundError itself, with the mesh.
      .def(
          "mesh",
          [](Problem& p, const std::string& word, int threads, double time_limit) {
            p.problem.allow_unsound = true;
            return mesh(p.problem, p.callbacks, word, threads, time_limit);
          },
          arg("word"), arg("threads"), arg("time_limit"));
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "The C++ part of delquad; see the package delquad.";
  // Later registrations are tried first.
  py::register_exception<InputError>(m, "InputError", PyExc_ValueError);
  const auto& cancelled = py::register_exception<Cancelled>(m, "Cancelled", PyExc_RuntimeError);
  py::register_exception<TimeIsUp>(m, "TimeIsUp", cancelled);
  define_mesh(m);
  define_criteria(m);
  define_result(m);
  define_models(m);
  define_problem(m);
  define_adapt(m);
  define_parts(m);
#ifdef DELQUAD_HAS_PROGRAM
  define_program(m);
#endif
  m.attr("__version__") = version();
  m.def("check_quality", [](const std::string& name) { quality_named(name); });
  m.def("qualities", [] {
    py::dict all;
    for (const Quality& quality : quality_registry()) all[py::str(quality.name)] = quality.pipeline;
    return all;
  });
}

}  // namespace delquad::python
