// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/context.h"
#include "delquad/extend.h"
#include "delquad/mesher.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/surface/triangulated_model.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/head.h"
#include "tests/support/model_maker.h"
#include "tests/support/patch_invariants.h"
#include "tests/support/prepare_surface.h"
#include "tests/support/shapes.h"
#include "tests/support/surfaces.h"
#include "tests/support/triangulated_shapes.h"

/// The head of tests of meshing: the public API, and shapes and checks that many of them use.
namespace delquad {
/// A problem of this model; a size of 0 gives none.
inline MeshProblem problem_of(Model model, double size = 0) {
  MeshProblem problem;
  problem.model = std::move(model);
  if (size > 0) problem.size.field = make_constant_size(size);
  return problem;
}

/// Meshing must throw InputError with a message that holds each of the parts.
inline void expect_refused(const MeshProblem& problem, const std::string& pipeline,
                           std::initializer_list<const char*> parts) {
  expect_input_error([&] { mesh(problem, pipeline); }, parts);
}

/// Runs `work` on each of these numbers of threads; its results must be equal. Returns the first.
template <class Work>
auto on_threads(std::initializer_list<int> numbers, Work&& work) {
  std::optional<decltype(work())> first;
  for (const int threads : numbers) {
    const RunScope run({.threads = threads});
    auto result = work();
    if (!first) first = result;
    EXPECT_TRUE(result == *first) << threads << " threads";
  }
  return *first;
}

/// The slope of `f` along x, which it reads, by central differences.
template <class F>
double slope_of(double& x, double step, F&& f) {
  const double at = x;
  x = at + step;
  const double above = f();
  x = at - step;
  const double below = f();
  x = at;
  return (above - below) / (2 * step);
}

}  // namespace delquad
