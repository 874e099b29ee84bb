// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header converts numpy arrays from and to lists of points and elements. The Python module uses it.
// `what` names an argument in messages. All readers throw InputError for other shapes and types.

namespace delquad::python {

namespace py = pybind11;

/// Reads numbers of shape (n, 2) or (n, 3); a missing z is 0.
std::vector<Vec3> read_points(const py::handle& object, const std::string& what);
/// Reads finite numbers of shape (n, 2).
std::vector<Vec2> read_plane_points(const py::handle& object, const std::string& what);
/// Reads two or three finite numbers.
Vec2 read_vec2(const py::handle& object, const std::string& what);
Vec3 read_vec3(const py::handle& object, const std::string& what);
/// Reads n numbers.
std::vector<double> read_numbers(const py::handle& object, const std::string& what);
/// Reads n integers.
std::vector<int> read_integers(const py::handle& object, const std::string& what);
/// Reads m11, m12, m13, m22, m23 and m33, of shape (n, 6).
std::vector<Tensor3> read_tensors(const py::handle& object, const std::string& what);
/// Reads n numbers from a callback into `target`; a single number is repeated.
void read_values(const py::handle& object, double* target, std::size_t n, const std::string& what);

/// Reads integers of shape (n, columns), row by row.
std::vector<int> read_table(const py::handle& object, int columns, const std::string& what);
template <std::size_t N>
std::vector<std::array<int, N>> read_elements(const py::handle& object, const std::string& what) {
  const std::vector<int> flat = read_table(object, N, what);
  std::vector<std::array<int, N>> elements(flat.size() / N);
  for (std::size_t i = 0; i < flat.size(); ++i) elements[i / N][i % N] = flat[i];
  return elements;
}

/// Returns a read-only view of numbers in rows, which keeps `owner` alive.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
  // Empty arrays have no address, and without one numpy would allocate them.
  static const T kNothing{};
  py::array_t<T> array(std::move(shape), data == nullptr ? &kNothing : data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
template <std::size_t N>
py::array view(const std::vector<std::array<int, N>>& elements, const py::object& owner) {
  return view<std::int32_t>(elements.empty() ? nullptr : elements[0].data(),
                            {static_cast<py::ssize_t>(elements.size()), N}, owner);
}
inline py::array view(const std::vector<int>& numbers, const py::object& owner) {
  return view<std::int32_t>(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, owner);
}
inline py::array view(const std::vector<double>& numbers, const py::object& owner) {
  return view<double>(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, owner);
}
inline py::array view(const std::vector<Vec3>& points, const py::object& owner) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return view<double>(points.empty() ? nullptr : &points[0].x, {static_cast<py::ssize_t>(points.size()), 3},
                      owner);
}

/// Returns a copy of points for a callback, which may keep it.
template <class V>
py::array points_for_python(std::span<const V> points) {
  constexpr py::ssize_t kColumns = sizeof(V) / sizeof(double);
  return py::array_t<double>({static_cast<py::ssize_t>(points.size()), kColumns},
                             points.empty() ? nullptr : &points[0].x);
}

/// Returns (tag, names) of each entity.
inline py::list list_of(const std::vector<Entity>& entities) {
  py::list list;
  for (const Entity& entity : entities) list.append(py::make_tuple(entity.tag, entity.names));
  return list;
}

}  // namespace delquad::python
