#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <string>

#include "bindings/python/calling_thread.h"
#include "delquad/mesher.h"

namespace delquad::python {

namespace py = pybind11;

/// What Python calls a model: a problem that may yet lack a size.
struct ModelHandle {
  MeshProblem problem;
};

/// A model file of any kind that the command line knows.
ModelHandle read_model(const std::string& path);

/// Tells Python of models and of what they are made of.
void define_models(py::module_& m);
/// HexMesh, and extrude() for each way.
void define_hexahedra(py::module_& m);

/// Functions that a problem calls; they are called in the thread that is there while it is meshed.
struct Callbacks {
  py::object size, cross, progress;  ///< None: not given
};

/// A mesh and all that is known of it.
struct Result : Mesh {
  MeshResult rest;  ///< its mesh is empty, and what it was made of
  double expected_quads = 0;
};

/// Meshes a problem, with the GIL released.
std::shared_ptr<Result> mesh(MeshProblem problem, const Callbacks& callbacks, const std::string& word,
                             int threads, double time_limit);

}  // namespace delquad::python
