// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/python/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/located.h"
#include "delquad/error.h"

namespace delquad::python {

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

/// Returns any array; ragged lists are refused.
py::array as_array(const py::handle& object, const std::string& what, const char* expected) {
  const py::array array = py::array::ensure(object);
  if (!array) PyErr_Clear();
  // Kinds of numpy: booleans, integers, floating-point numbers.
  if (!array || std::string("biuf").find(array.dtype().kind()) == std::string::npos)
    refuse(
        "{}: expected {}, got {}", what, expected,
        array && array.dtype().kind() != 'O'
            ? "an array of type " + std::string(py::str(array.dtype()))
            : "a " + std::string(py::str(py::type::of(object).attr("__name__"))) + " that is no such array");
  return array;
}

InputError bad_shape(const std::string& what, const char* expected, const py::array& array) {
  return InputError(
      fmt::format("{}: expected {}, got an array of shape {}", what, expected, shape_of(array)));
}

void require_finite(const std::vector<Vec2>& points, const std::string& what) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y))
      refuse("{}: point {} is ({}, {}): expected finite coordinates", what, i, points[i].x, points[i].y);
}

int checked_int(std::int64_t value, const std::string& what) {
  if (!std::in_range<int>(value)) refuse("{}: {} is out of range", what, value);
  return static_cast<int>(value);
}

Integers as_integers(const py::handle& object, const std::string& what, const char* expected) {
  const py::array array = as_array(object, what, expected);
  if (array.dtype().kind() == 'f' && array.size() > 0)
    refuse("{}: expected {}, got an array of type {}", what, expected, std::string(py::str(array.dtype())));
  return Integers(array);
}

std::vector<double> read_vector(const py::handle& object, std::size_t n, const std::string& what) {
  std::vector<double> numbers = read_numbers(object, what);
  if (numbers.size() != n) refuse("{}: expected {} numbers, got {}", what, n, numbers.size());
  for (const double x : numbers)
    if (!std::isfinite(x)) refuse("{}: is {}: expected finite coordinates", what, x);
  return numbers;
}

/// Calls `make` for each row of numbers; its length must be in `columns`.
template <class Row>
std::vector<Row> read_rows(const py::handle& object, const std::string& what, const char* expected,
                           const std::set<py::ssize_t>& columns, Row (*make)(const double*, py::ssize_t)) {
  const Doubles array(as_array(object, what, expected));
  if (array.ndim() == 1 && array.size() == 0) return {};
  if (array.ndim() != 2 || !columns.contains(array.shape(1))) throw bad_shape(what, expected, array);
  std::vector<Row> rows;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) rows.push_back(make(array.data(i, 0), array.shape(1)));
  return rows;
}

}  // namespace

std::vector<Vec3> read_points(const py::handle& object, const std::string& what) {
  return read_rows<Vec3>(object, what, "numbers of shape (n, 2) or (n, 3)", {2, 3},
                         [](const double* x, py::ssize_t n) {
                           return Vec3{x[0], x[1], n == 3 ? x[2] : 0};
                         });
}

std::vector<Tensor3> read_tensors(const py::handle& object, const std::string& what) {
  return read_rows<Tensor3>(object, what, "numbers of shape (n, 6)", {6}, [](const double* m, py::ssize_t) {
    return Tensor3{m[0], m[1], m[2], m[3], m[4], m[5]};
  });
}

std::vector<Vec2> read_plane_points(const py::handle& object, const std::string& what) {
  const auto points =
      read_rows<Vec2>(object, what, "numbers of shape (n, 2)", {2}, [](const double* x, py::ssize_t) {
        return Vec2{x[0], x[1]};
      });
  require_finite(points, what);
  return points;
}

Vec2 read_vec2(const py::handle& object, const std::string& what) {
  const std::vector<double> v = read_vector(object, 2, what);
  return {v[0], v[1]};
}

Vec3 read_vec3(const py::handle& object, const std::string& what) {
  const std::vector<double> v = read_vector(object, 3, what);
  return {v[0], v[1], v[2]};
}

std::vector<double> read_numbers(const py::handle& object, const std::string& what) {
  constexpr const char* kExpected = "numbers of shape (n,)";
  const Doubles array(as_array(object, what, kExpected));
  if (array.ndim() != 1) throw bad_shape(what, kExpected, array);
  return {array.data(), array.data() + array.size()};
}

std::vector<int> read_integers(const py::handle& object, const std::string& what) {
  constexpr const char* kExpected = "whole numbers of shape (n,)";
  const Integers array = as_integers(object, what, kExpected);
  if (array.ndim() != 1) throw bad_shape(what, kExpected, array);
  std::vector<int> numbers;
  for (py::ssize_t i = 0; i < array.size(); ++i) numbers.push_back(checked_int(array.data()[i], what));
  return numbers;
}

void read_values(const py::handle& object, double* target, std::size_t n, const std::string& what) {
  const std::string expected = fmt::format("{} numbers, one for each point", n);
  const Doubles array(as_array(object, what, expected.c_str()));
  if (array.ndim() == 0) {
    std::fill_n(target, n, *array.data());
  } else if (array.ndim() == 1 && static_cast<std::size_t>(array.size()) == n) {
    std::copy_n(array.data(), n, target);
  } else {
    throw bad_shape(what, expected.c_str(), array);
  }
}

std::vector<int> read_table(const py::handle& object, int columns, const std::string& what) {
  const std::string expected = fmt::format("whole numbers of shape (n, {})", columns);
  const Integers array = as_integers(object, what, expected.c_str());
  if (array.ndim() == 1 && array.size() == 0) return {};
  if (array.ndim() != 2 || array.shape(1) != columns) throw bad_shape(what, expected.c_str(), array);
  std::vector<int> numbers;
  for (py::ssize_t i = 0; i < array.size(); ++i) numbers.push_back(checked_int(array.data()[i], what));
  return numbers;
}

}  // namespace delquad::python
