// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/packed_mesh.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <optional>
#include <set>
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
  void put(std::ptrdiff_t number) { put(static_cast<std::size_t>(number)); }
  template <class Numbers>
  void put_all(const Numbers& numbers) {
    for (const int number : numbers) put(number);
  }
  std::string packed() const { return packed_text(bytes_); }

 private:
  std::string bytes_;
};

std::size_t class_of(double quality) {
  return static_cast<std::size_t>(std::clamp(quality * kEtaClasses, 0.0, kEtaClasses - 1));
}

/// Returns the mesh with the sides between cells, too, as faces of a further region.
Mesh with_sides_inside(Mesh mesh) {
  const std::vector<SolidSide> sides = sorted_sides(mesh);
  std::set<std::array<int, 4>> known;
  for (const auto& v : mesh.triangles) known.insert(side_key(v));
  for (const auto& v : mesh.quads) known.insert(side_key(v));
  for (const SolidSide& side : sides) {
    if (!known.insert(side.nodes).second) continue;
    const auto [a, b, c, d] =
        solid_at(mesh, static_cast<std::size_t>(side.side.element)).side(side.side.side);
    if (d < 0) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangle_region.push_back(static_cast<int>(mesh.regions.size()));
    } else {
      mesh.quads.push_back({a, b, c, d});
      mesh.quad_region.push_back(static_cast<int>(mesh.regions.size()));
    }
  }
  return mesh;
}

/// Puts the cells of each face, then place, shape and class of the scaled Jacobian of each cell.
void put_cells(Arrays& out, const Mesh& mesh, const Vec3& origin) {
  const std::vector<double> jacobian = measure(mesh).jacobian;
  const CellSides sides(mesh);
  for (std::size_t f = 0; f < n_cells(mesh, 2); ++f) {
    const std::vector<CellSide> at = sides.at(static_cast<int>(f));
    for (const std::size_t k : {0u, 1u})
      out.put(k < at.size() ? static_cast<std::size_t>(at[k].element) : jacobian.size());
  }
  for (std::size_t i = 0; i < jacobian.size(); ++i) {
    const Solid cell = solid_at(mesh, i);
    Vec3 sum;
    for (const int v : cell.nodes) sum = sum + (mesh.points[v] - origin);
    for (double Vec3::*const axis : {&Vec3::x, &Vec3::y, &Vec3::z})
      out.put(static_cast<float>(sum.*axis / static_cast<double>(cell.nodes.size())));
  }
  for (std::size_t i = 0; i < jacobian.size(); ++i) out.put(solid_at(mesh, i).shape - kSolidShapes.data());
  for (const double value : jacobian) out.put(class_of(value));
}

}  // namespace

PackedMesh pack_mesh(const Mesh& given, const std::vector<std::size_t>& failing, bool with_entities) {
  Arrays out;
  std::optional<Mesh> with_sides;
  if (with_entities && is_solid(given)) with_sides = with_sides_inside(given);
  const Mesh& mesh = with_sides ? *with_sides : given;
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
  for (const double eta : quad_etas(mesh)) classes.push_back(class_of(eta));
  for (const std::size_t q : failing) classes[q] = static_cast<std::size_t>(kEtaClasses);
  for (const std::size_t eta : classes) out.put(eta);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const std::vector<int> nodes = nodes_of_line(mesh, l);
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) out.put_all(std::span(nodes).subspan(k, 2));
  }
  const std::vector<double> sizes(mesh.triangles.size() + mesh.quads.size(), 1);
  const auto [vertices, pairs] =
      is_solid(mesh) ? IrregularVertices{} : irregular_vertices(mesh, mesh.quads.empty() ? 6 : 4, sizes);
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
  if (with_sides) put_cells(out, mesh, low);
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
           {"cells", with_sides ? n_solids(mesh) : 0},
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
