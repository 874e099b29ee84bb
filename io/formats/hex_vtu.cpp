#include <limits>

#include "io/formats/vtu.h"
#include "io/formats/vtu_output.h"

namespace delquad {

void write_hex_vtu(const std::filesystem::path& path, const HexMesh& mesh) {
  constexpr std::uint8_t kLine = 3, kQuad = 9, kHexahedron = 12;  // VTK's cell types
  VtuContent content{mesh.points, mesh.unit, {}, {}, {}, {}};
  content.names = {{"volume", tags_of_names(mesh.volumes)},
                   {"face", tags_of_names(mesh.faces)},
                   {"curve", tags_of_names(mesh.curves)}};
  content.tags = {{"volume", {}}, {"face", {}}, {"curve", {}}};
  const auto add = [&](const auto& nodes, std::uint8_t type, std::array<int, 3> tags) {
    content.cells.add(nodes, type);
    for (std::size_t k = 0; k < tags.size(); ++k) content.tags[k].second.push_back(tags[k]);
  };
  for (std::size_t i = 0; i < mesh.hexahedra.size(); ++i)
    add(mesh.hexahedra[i], kHexahedron, {mesh.volumes[mesh.hex_volume[i]].tag, 0, 0});
  for (std::size_t i = 0; i < mesh.quads.size(); ++i)
    add(mesh.quads[i], kQuad, {0, mesh.faces[mesh.quad_face[i]].tag, 0});
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
    add(mesh.lines[i], kLine, {0, 0, mesh.curves[mesh.line_curve[i]].tag});
  std::vector<double>& jacobian = content.values["scaled Jacobian"];
  jacobian = measure(mesh).jacobian;
  jacobian.resize(content.cells.types.size(), std::numeric_limits<double>::quiet_NaN());
  write_vtu_content(path, content);
}

}  // namespace delquad
