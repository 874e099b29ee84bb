#include <pybind11/stl.h>

#include "base/context.h"
#include "bindings/python/arrays.h"
#include "bindings/python/problem.h"
#include "delquad/hexahedra.h"

namespace delquad::python {

namespace {

using py::arg;

/// With what is measured of it.
struct Hexahedra {
  Mesh mesh;
  HexMeasures measures;
};

/// A list of the hexahedra as a property: a view that keeps them.
template <class List>
auto hex_view(List Mesh::*member) {
  return [member](const py::object& self) { return view(self.cast<const Hexahedra&>().mesh.*member, self); };
}

auto hex_entities(std::vector<Entity> Mesh::*member) {
  return [member](const Hexahedra& self) { return list_of(self.mesh.*member); };
}

Hexahedra sweep(const Mesh& mesh, const SweepPath& path, int layers, double growth, int threads,
                double time_limit) {
  Hexahedra result;
  CallingThread().run([&](const std::stop_token& stop) {
    const RunScope scope({.threads = threads, .cancel = stop, .seconds = time_limit});
    result.mesh = extrude(mesh, path, {layers, growth});
    result.measures = measure(result.mesh);
  });
  return result;
}

template <class... More>
void define_way(py::module_& m, const char* name, SweepPath (*path)(const py::object&, More...)) {
  m.def(name, [path](const Mesh& mesh, int layers, double growth, int threads, double time_limit,
                     const py::object& first, More... more) {
    return sweep(mesh, path(first, more...), layers, growth, threads, time_limit);
  });
}

}  // namespace

void define_hexahedra(py::module_& m) {
  py::class_<Hexahedra>(m, "HexMesh", "Hexahedra, quads on their named faces; indices count from 0.")
      .def_property_readonly("points", hex_view(&Mesh::points), "(n, 3) coordinates")
      .def_property_readonly("hexahedra", hex_view(&Mesh::hexahedra), "(n, 8) points")
      .def_property_readonly("hex_volume", hex_view(&Mesh::hex_volume),
                             "index into volumes of each hexahedron")
      .def_property_readonly("quads", hex_view(&Mesh::quads), "(n, 4) points of quads on faces")
      .def_property_readonly("quad_face", hex_view(&Mesh::quad_region), "index into faces of each quad")
      .def_property_readonly("lines", hex_view(&Mesh::lines), "(n, 2) points of edges on curves")
      .def_property_readonly("line_curve", hex_view(&Mesh::line_curve), "index into curves of each line")
      .def_property_readonly("volumes", hex_entities(&Mesh::volumes), "(tag, names)")
      .def_property_readonly("faces", hex_entities(&Mesh::regions), "(tag, names)")
      .def_property_readonly("curves", hex_entities(&Mesh::curves), "(tag, names)")
      .def_property_readonly(
          "unit", [](const Hexahedra& self) { return self.mesh.unit; }, "of lengths; empty: not known")
      .def_property_readonly(
          "volume", [](const Hexahedra& self) { return self.measures.volume; }, "of all hexahedra")
      .def_property_readonly(
          "scaled_jacobian",
          [](const py::object& self) {
            const std::vector<double>& values = self.cast<const Hexahedra&>().measures.jacobian;
            return view<double>(values.data(), {static_cast<py::ssize_t>(values.size())}, self);
          },
          "the least of each hexahedron, 1 for boxes")
      .def(
          "_write_file",
          [](const Hexahedra& self, const std::string& path, bool binary, const std::string& element) {
            const py::gil_scoped_release released;
            write_mesh(path, self.mesh, {.binary = binary, .element = element});
          },
          arg("path"), arg("binary") = false, arg("element") = "");
  define_way(
      m, "extrude_along",
      +[](const py::object& shift) -> SweepPath { return AlongVector{read_vec3(shift, "along")}; });
  define_way(
      m, "extrude_around", +[](const py::object& point, py::object axis, double degrees) -> SweepPath {
        return AroundAxis{read_vec3(point, "around: the point"), read_vec3(axis, "around: the axis"),
                          degrees};
      });
  define_way(
      m, "extrude_curve",
      +[](const py::object& points) -> SweepPath { return AlongCurve{read_points(points, "curve")}; });
  define_way(
      m, "extrude_normals", +[](const py::object& thickness, bool both_sides) -> SweepPath {
        return AlongNormals{thickness.cast<double>(), both_sides};
      });
}

}  // namespace delquad::python
