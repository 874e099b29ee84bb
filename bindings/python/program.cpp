#include <csignal>

#include <pybind11/stl.h>

#include "bindings/python/problem.h"
#include "delquad/bench.h"
#include "experiments/sweep/cells.h"

namespace delquad::python {

namespace {

/// As the program does it, but signals are Python's again afterwards.
int run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "delquad");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  struct sigaction interrupt = {}, end = {}, file_size = {};
  sigaction(SIGINT, nullptr, &interrupt);
  sigaction(SIGTERM, nullptr, &end);
  sigaction(SIGXFSZ, nullptr, &file_size);
  const py::gil_scoped_release released;
  const int code = run_program(static_cast<int>(arguments.size()), argv.data());
  sigaction(SIGINT, &interrupt, nullptr);
  sigaction(SIGTERM, &end, nullptr);
  sigaction(SIGXFSZ, &file_size, nullptr);
  return code;
}

}  // namespace

void define_program(py::module_& m) {
  m.def("run", &run, py::arg("arguments"));
  m.def("add_to_program", &add_to_program, py::arg("text"));
}

}  // namespace delquad::python
