// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#define TETLIBRARY
#include <tetgen.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "base/orientation.h"
#include "base/process.h"

namespace delquad {

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// Circumradii below 1.4 edges and dihedral angles above 16 degrees where possible, no points on the
/// boundary, all points kept, no output.
constexpr char kSwitches[] = "pYq1.4/16JQ";

/// Returns the new points and the tetrahedra as bytes; empty: TetGen refuses the input.
std::string run_tetgen(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                       const std::vector<Vec3>& holes) {
  // The structure frees its lists itself, by delete[].
  const auto copy = [](const std::vector<Vec3>& from) {
    double* to = new double[3 * from.size()];
    std::memcpy(to, from.data(), from.size() * sizeof(Vec3));
    return to;
  };
  tetgenio in, out;
  in.numberofpoints = static_cast<int>(points.size());
  in.pointlist = copy(points);
  in.numberofholes = static_cast<int>(holes.size());
  in.holelist = copy(holes);
  in.numberoffacets = static_cast<int>(triangles.size());
  in.facetlist = new tetgenio::facet[triangles.size()];
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& t = triangles[i];
    tetgenio::init(&in.facetlist[i]);
    in.facetlist[i].numberofpolygons = 1;
    in.facetlist[i].polygonlist = new tetgenio::polygon[1]{{new int[3]{t[0], t[1], t[2]}, 3}};
  }
  std::string switches = kSwitches;
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int) {
    return "";
  }
  const auto bytes = [](const auto* from, int n) {
    return std::string(reinterpret_cast<const char*>(from), n * sizeof(*from));
  };
  return bytes(&out.numberofpoints, 1) + bytes(out.pointlist, 3 * out.numberofpoints) +
         bytes(out.tetrahedronlist, 4 * out.numberoftetrahedra);
}

}  // namespace

std::optional<Mesh> tetrahedralise(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                   const std::vector<Vec3>& holes) {
  constexpr unsigned kSeconds = 60, kTrianglesPerSecond = 1000;  // a hundred times its usual time
  Mesh given;
  given.points = points, given.triangles = triangles;
  const std::vector<int> used = keep_used_points(given);
  const auto bytes = call_in_child([&] { return run_tetgen(given.points, given.triangles, holes); },
                                   kSeconds + static_cast<unsigned>(triangles.size()) / kTrianglesPerSecond);
  int n = 0;
  if (!bytes || bytes->size() < sizeof n) return std::nullopt;
  std::memcpy(&n, bytes->data(), sizeof n);
  const int n_used = static_cast<int>(used.size()), n_given = static_cast<int>(points.size());
  if (n < n_used) return std::nullopt;
  Mesh result;
  result.points = points;
  result.points.resize(n_given + n - n_used);
  const char* at = bytes->data() + sizeof n + n_used * sizeof(Vec3);
  std::memcpy(result.points.data() + n_given, at, (n - n_used) * sizeof(Vec3));
  at += (n - n_used) * sizeof(Vec3);
  result.tetrahedra.resize((bytes->data() + bytes->size() - at) / sizeof(result.tetrahedra[0]));
  std::memcpy(result.tetrahedra.data(), at, result.tetrahedra.size() * sizeof(result.tetrahedra[0]));
  const auto& p = result.points;
  for (auto& c : result.tetrahedra) {
    for (int& v : c) v = v < n_used ? used[v] : v - n_used + n_given;
    if (orient3d(p[c[0]], p[c[1]], p[c[2]], p[c[3]]) < 0) std::swap(c[0], c[1]);
  }
  result.tet_volume.assign(result.tetrahedra.size(), 0);
  return result;
}

}  // namespace delquad
