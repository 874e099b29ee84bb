#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "geometry/mesh/element_nodes.h"
#include "io/formats/vtu.h"
#include "io/formats/vtu_output.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"

namespace delquad {

namespace {

NumbersOfNames points_of_names(const Mesh& mesh) {
  NumbersOfNames points;
  for (const NamedPoint& named : mesh.named_points)
    for (const std::string& name : named.entity.names) points[name].push_back(named.point);
  return points;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const Mesh& mesh,
               const std::map<std::string, std::vector<double>>& cell_data, QuadNodes nodes) {
  // VTK's cell types: straight, quadratic and biquadratic, Lagrange.
  constexpr std::array<std::uint8_t, 4> kLines = {3, 21, 68, 68}, kQuads = {9, 28, 70, 70};
  constexpr std::uint8_t kTriangle = 5, kEightNodes = 23;
  const size_t order = static_cast<size_t>(mesh.order) - 1;
  VtuContent content{mesh.points, mesh.unit, {}, {}, {}, cell_data};
  content.names = {{"curve", tags_of_names(mesh.curves)},
                   {"region", tags_of_names(mesh.regions)},
                   {"point", points_of_names(mesh)}};
  content.tags = {{"curve", {}}, {"region", {}}};
  const auto add = [&](const auto& of_cell, std::uint8_t type, int curve, int region) {
    content.cells.add(of_cell, type);
    content.tags[0].second.push_back(curve);
    content.tags[1].second.push_back(region);
  };
  for (size_t i = 0; i < mesh.lines.size(); ++i)
    add(nodes_ends_first(mesh, i), kLines[order], mesh.curves[mesh.line_curve[i]].tag, 0);
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    add(mesh.triangles[i], kTriangle, 0, mesh.regions[mesh.triangle_region[i]].tag);
  std::vector<int> places = vtk_places(mesh.order);
  if (nodes == QuadNodes::kNoMiddle) places.pop_back();
  const std::uint8_t of_quads = nodes == QuadNodes::kNoMiddle ? kEightNodes : kQuads[order];
  for (size_t i = 0; i < mesh.quads.size(); ++i)
    add(nodes_of_quad(mesh, i, places), of_quads, 0, mesh.regions[mesh.quad_region[i]].tag);
  for (const auto& [name, values] : cell_data) {
    if (values.size() != content.cells.types.size()) {
      throw std::invalid_argument("cell data '" + name + "': " + std::to_string(values.size()) +
                                  " values for " + std::to_string(content.cells.types.size()) + " cells");
    }
  }
  write_vtu_content(path, content);
}

namespace {

void write_with_eta(const std::filesystem::path& path, const Mesh& mesh, const MshOptions&, QuadNodes nodes) {
  std::vector<double> eta(mesh.lines.size() + mesh.triangles.size(),
                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> of_quads = quad_etas(mesh);
  eta.insert(eta.end(), of_quads.begin(), of_quads.end());
  write_vtu(path, mesh, {{"eta", eta}}, nodes);
}

}  // namespace

MeshFormat vtu_format() {
  return {.extensions = {".vtu"},
          .description = "VTK XML, ParaView",
          .read = read_by<read_vtu>,
          .write = write_with_eta,
          .most_order = kMostOrder,
          .write_hexahedra = [](const std::filesystem::path& path, const HexMesh& mesh,
                                bool) { write_hex_vtu(path, mesh); },
          .eight_nodes = EightNodes::kWhenAsked};
}

}  // namespace delquad
