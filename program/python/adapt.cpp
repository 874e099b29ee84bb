// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/adapt.h"

#include <pybind11/stl.h>

#include <utility>

#include "base/context.h"
#include "program/python/arrays.h"
#include "program/python/problem.h"

namespace delquad::python {

namespace {

using py::arg;

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Returns (gradient of shape (n, 2), Hessian of shape (n, 3)) at the points. Between regions the side with
/// the larger Hessian counts.
py::tuple recovered(const Mesh& mesh, const py::object& values) {
  const std::vector<double> given = read_numbers(values, "values");
  Recovery made;
  CallingThread().run([&](const std::stop_token& stop) {
    const RunScope scope({.cancel = stop});
    made = recover(mesh, given);
  });
  const auto n = static_cast<py::ssize_t>(mesh.points.size());
  py::array_t<double> gradient({n, py::ssize_t{2}}), hessian({n, py::ssize_t{3}});
  auto g = gradient.mutable_unchecked<2>(), h = hessian.mutable_unchecked<2>();
  std::vector<double> size(mesh.points.size(), -1);
  for (std::size_t i = 0; i < made.origin.size(); ++i) {
    const int at = made.origin[i];
    const Tensor2& m = made.hessian[i];
    const double here = m.xx * m.xx + 2 * m.xy * m.xy + m.yy * m.yy;
    if (here <= size[at]) continue;
    size[at] = here;
    g(at, 0) = made.gradient[i].x, g(at, 1) = made.gradient[i].y;
    h(at, 0) = m.xx, h(at, 1) = m.xy, h(at, 2) = m.yy;
  }
  return py::make_tuple(gradient, hessian);
}

/// Returns the errors of interpolation and gradient, each in total and by element.
py::tuple estimated(const Mesh& mesh, const py::object& values, double norm) {
  const Recovery made = recover(mesh, read_numbers(values, "values"));
  const ErrorEstimate error = interpolation_error(made, norm), gradient = gradient_error(made);
  return py::make_tuple(error.whole, array_of(error.of_elements), gradient.whole,
                        array_of(gradient.of_elements));
}

Transfer transfer_named(const std::string& how) {
  if (how == "interpolated") return Transfer::kInterpolated;
  if (how == "conservative") return Transfer::kConservative;
  if (how == "bounded") return Transfer::kBounded;
  throw InputError("how: '" + how + "': expected 'interpolated', 'conservative' or 'bounded'");
}

py::array transferred(const Mesh& from, const py::object& values, const Mesh& to, const std::string& how,
                      bool of_elements) {
  const std::vector<double> given = read_numbers(values, "values");
  const Transfer way = transfer_named(how);
  std::vector<double> made;
  CallingThread().run([&](const std::stop_token& stop) {
    const RunScope scope({.cancel = stop});
    made = of_elements ? transfer_elements(from, given, to, way) : transfer_points(from, given, to, way);
  });
  return array_of(made);
}

py::tuple adapted(const Mesh& mesh, const std::vector<std::pair<std::string, py::object>>& fields,
                  AdaptSpec spec, const py::object& weight, const ModelHandle* model, int threads,
                  double time_limit) {
  std::vector<NodalField> given;
  for (const auto& [name, values] : fields)
    given.push_back({name, read_numbers(values, "the field " + name)});
  if (!weight.is_none()) spec.weight = read_numbers(weight, "weight");
  Adapted made;
  CallingThread().run([&](std::stop_token stop) {
    Context context;
    context.threads = threads;
    context.time_limit = time_limit;
    context.cancel = std::move(stop);
    made = adapt(mesh, given, spec, model == nullptr ? nullptr : &model->problem, context);
  });
  py::dict errors;
  using namespace py::literals;
  for (std::size_t f = 0; f < given.size(); ++f)
    errors[py::str(given[f].name)] =
        py::dict("now"_a = made.errors[f].now, "gradient"_a = made.errors[f].gradient,
                 "expected"_a = made.errors[f].after);
  return py::make_tuple(as_result(std::move(made.result)), errors);
}

}  // namespace

void define_adapt(py::module_& m) {
  py::class_<AdaptSpec>(m, "AdaptSpec", "Goals of the next mesh.")
      .def(py::init([](double quads, double error, double norm, double min, double max, double aspect,
                       double gradation, bool isotropic, const std::string& quality) {
        return AdaptSpec{quads, error, norm, {min, max, aspect}, gradation, isotropic, {}, quality};
      }));
  m.def("recover", &recovered, arg("mesh"), arg("values"));
  m.def("estimate", &estimated, arg("mesh"), arg("values"), arg("norm"));
  m.def("transfer", &transferred, arg("mesh"), arg("values"), arg("to"), arg("how"), arg("of_elements"));
  m.def("adapt", &adapted, arg("mesh"), arg("fields"), arg("spec"), arg("weight"), arg("model").none(true),
        arg("threads"), arg("time_limit"));
}

}  // namespace delquad::python
