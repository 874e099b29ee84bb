#include <pybind11/stl.h>

#include "base/parallel.h"
#include "bindings/python/problem.h"
#include "delquad/bench.h"
#include "experiments/sweep/cells.h"

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
  m.def("run", &run, py::arg("arguments"));
  m.def("finish_threads", &finish_threads);
  m.def("set_added_parts", &set_added_parts, py::arg("text"));
}

}  // namespace delquad::python
