// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include "base/parallel.h"
#include "delquad/bench.h"
#include "experiments/report/write_view.h"
#include "experiments/sweep/cells.h"
#include "program/python/problem.h"

namespace delquad::python {

namespace {

int run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "delquad");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const py::gil_scoped_release released;
  return run_program(static_cast<int>(arguments.size()), argv.data());
}

}  // namespace

void define_program(py::module_& m) {
  m.def(
      "write_view",
      [](const std::string& path, const Mesh& mesh, const std::string& title,
         const std::vector<std::string>& warnings) {
        const py::gil_scoped_release released;
        write_view(path, mesh, title, {.warnings = warnings});
      },
      py::arg("path"), py::arg("mesh"), py::arg("title"), py::arg("warnings"));
  m.def("run", &run, py::arg("arguments"));
  m.def("finish_threads", &finish_threads);
  m.def("set_added_parts", &set_added_parts, py::arg("text"));
}

}  // namespace delquad::python
