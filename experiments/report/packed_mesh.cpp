// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/packed_mesh.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <span>

#include "base/box.h"
#include "delquad/hexahedra.h"
#include "geometry/mesh/element_nodes.h"
#include "io/cell_view.h"
#include "io/picture.h"
#include "io/xml.h"

namespace delquad {
namespace {

constexpr double kEtaClasses = 128;

class Arrays {
 public:
  void put(float number) { bytes_.append(reinterpret_cast<const char*>(&number), sizeof number); }
  void put(std::size_t number) {
    const auto n = static_cast<std::uint32_t>(number);
    bytes_.append(reinterpret_cast<const char*>(&n), sizeof n);
  }
  void put(int number) { put(static_cast<std::size_t>(number)); }
  template <class Numbers>
  void put_all(const Numbers& numbers) {
    for (const int number : numbers) put(number);
  }
  std::string packed() const { return packed_text(bytes_); }

 private:
  std::string bytes_;
};

/// Returns eta of each quad, or the least scaled Jacobian, from 0 on, of hexahedra at it.
std::vector<double> qualities(const Mesh& mesh) {
  if (mesh.hexahedra.empty()) return quad_etas(mesh);
  const std::vector<double> jacobian = measure(mesh).jacobian;
  const CellSides sides(mesh);
  std::vector<double> least(mesh.quads.size(), 1);
  for (std::size_t q = 0; q < least.size(); ++q)
    for (const auto& [element, side] : sides.at(static_cast<int>(q)))
      least[q] = std::min(least[q], std::max(0.0, jacobian[element]));
  return least;
}

}  // namespace

PackedMesh pack_mesh(const Mesh& mesh, const std::vector<std::size_t>& failing, bool with_entities) {
  Arrays out;
  const Vec3 low = mesh.points.empty() ? Vec3{} : Box<Vec3>::around(std::span(mesh.points)).low;
  bool is_flat = true;
  for (double Vec3::*const axis : {&Vec3::x, &Vec3::y, &Vec3::z})
    for (const Vec3& p : mesh.points) {
      out.put(static_cast<float>(p.*axis - low.*axis));
      is_flat = is_flat && p.z == low.z;
    }
  for (const auto& v : mesh.triangles) out.put_all(v);
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) out.put_all(nodes_around(mesh, q));
  std::vector<std::size_t> classes;
  for (const double eta : qualities(mesh))
    classes.push_back(static_cast<std::size_t>(std::min(eta * kEtaClasses, kEtaClasses - 1)));
  for (const std::size_t q : failing) classes[q] = static_cast<std::size_t>(kEtaClasses);
  for (const std::size_t eta : classes) out.put(eta);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const std::vector<int> nodes = nodes_of_line(mesh, l);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) out.put_all(std::span(nodes).subspan(k, 2));
  }
  const std::vector<double> sizes(mesh.triangles.size() + mesh.quads.size(), 1);
  const auto [vertices, pairs] = irregular_vertices(mesh, mesh.quads.empty() ? 6 : 4, sizes);
  for (const IrregularVertex& v : vertices) {
    out.put(v.vertex);
    out.put(v.valence);
  }
  for (const auto& pair : pairs) out.put_all(pair);
  if (with_entities) {
    out.put_all(mesh.triangle_region);
    out.put_all(mesh.quad_region);
    for (const int curve : mesh.line_curve)
      for (int k = 0; k < mesh.order; ++k) out.put(curve);
  }
  return {{{"failing", failing.size()},
           {"dimension", is_flat ? 2 : 3},
           {"order", mesh.order},
           {"points", mesh.points.size()},
           {"triangles", mesh.triangles.size()},
           {"quads", mesh.quads.size()},
           {"lines", mesh.lines.size() * static_cast<std::size_t>(mesh.order)},
           {"irregular", vertices.size()},
           {"pairs", pairs.size()},
           {"origin", {low.x, low.y, low.z}},
           {"entities", with_entities}},
          out.packed()};
}

std::string packed_text(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  auto* const to = reinterpret_cast<Bytef*>(packed.data());
  const auto* const from = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(to, &size, from, bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();  // its only reason, given room enough
  packed.resize(size);
  return base64(packed);
}

}  // namespace delquad
