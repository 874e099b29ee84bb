#include <algorithm>
#include <limits>

#include "base/box.h"
#include "io/formats/msh.h"
#include "io/formats/msh_output.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

/// One entity with its elements.
struct HexBlock {
  int dim, type;  ///< Gmsh's type of elements
  const Entity* entity;
  std::string group;
  std::vector<std::vector<int>> elements;
  std::vector<int> nodes;  ///< those that no entity before has
  int group_tag = 0;
  Box<Vec3> box;
};

template <std::size_t N>
void add_hex_blocks(int dim, int type, const std::vector<Entity>& entities,
                    const std::vector<std::array<int, N>>& elements, const std::vector<int>& entity_of,
                    const std::vector<Vec3>& points, std::vector<HexBlock>& blocks) {
  constexpr double kMax = std::numeric_limits<double>::max();
  const std::vector<std::string> groups = group_names(entities, dim);
  const std::size_t first = blocks.size();
  for (std::size_t i = 0; i < entities.size(); ++i)
    blocks.push_back(
        {dim, type, &entities[i], groups[i], {}, {}, 0, {{kMax, kMax, kMax}, {-kMax, -kMax, -kMax}}});
  for (std::size_t i = 0; i < elements.size(); ++i) {
    HexBlock& block = blocks[first + static_cast<std::size_t>(entity_of[i])];
    block.elements.emplace_back(elements[i].begin(), elements[i].end());
    for (const int v : elements[i]) block.box.add(points[v]);
  }
}

/// Curves first, then faces, then volumes; a node is of the first that has it.
std::vector<HexBlock> make_hex_blocks(const HexMesh& mesh) {
  std::vector<HexBlock> blocks;
  add_hex_blocks(1, 1, mesh.curves, mesh.lines, mesh.line_curve, mesh.points, blocks);
  add_hex_blocks(2, 3, mesh.faces, mesh.quads, mesh.quad_face, mesh.points, blocks);
  add_hex_blocks(3, 5, mesh.volumes, mesh.hexahedra, mesh.hex_volume, mesh.points, blocks);
  std::erase_if(blocks, [](const HexBlock& block) { return block.elements.empty(); });
  std::vector<char> is_taken(mesh.points.size(), 0);
  for (HexBlock& block : blocks) {
    for (const auto& element : block.elements)
      for (const int v : element)
        if (!std::exchange(is_taken[v], 1)) block.nodes.push_back(v);
    std::sort(block.nodes.begin(), block.nodes.end());
  }
  return blocks;
}

void write_hex_entities(MshNumbers& out, const std::vector<HexBlock>& blocks) {
  out.line("$Entities");
  out.size(0);
  for (const int dim : {1, 2, 3})
    out.size(static_cast<std::size_t>(std::ranges::count(blocks, dim, &HexBlock::dim)));
  out.end_line();
  for (const HexBlock& block : blocks) {
    out.integer(block.entity->tag).point(block.box.low).point(block.box.high);
    out.size(1).integer(block.group_tag).size(0).end_line();
  }
  out.end_section("$EndEntities");
}

void write_hex_nodes(MshNumbers& out, const HexMesh& mesh, const std::vector<HexBlock>& blocks) {
  out.line("$Nodes");
  out.size(blocks.size()).size(mesh.points.size()).size(1).size(mesh.points.size()).end_line();
  for (const HexBlock& block : blocks) {
    out.integer(block.dim).integer(block.entity->tag).integer(0).size(block.nodes.size()).end_line();
    for (const int i : block.nodes) out.size(static_cast<std::size_t>(i) + 1).end_line();
    for (const int i : block.nodes) out.point(mesh.points[i]).end_line();
  }
  out.end_section("$EndNodes");
}

void write_hex_elements(MshNumbers& out, const std::vector<HexBlock>& blocks) {
  std::size_t count = 0;
  for (const HexBlock& block : blocks) count += block.elements.size();
  out.line("$Elements");
  out.size(blocks.size()).size(count).size(1).size(count).end_line();
  std::size_t tag = 0;
  for (const HexBlock& block : blocks) {
    out.integer(block.dim)
        .integer(block.entity->tag)
        .integer(block.type)
        .size(block.elements.size())
        .end_line();
    for (const auto& element : block.elements) {
      out.size(++tag);
      for (const int v : element) out.size(static_cast<std::size_t>(v) + 1);
      out.end_line();
    }
  }
  out.end_section("$EndElements");
}

}  // namespace

void write_hex_msh(const std::filesystem::path& path, const HexMesh& mesh, bool binary) {
  std::vector<HexBlock> blocks = make_hex_blocks(mesh);
  std::vector<UniqueLabels::Key> keys;
  std::vector<MshEntity> entities;
  for (const HexBlock& block : blocks) {
    keys.emplace_back(block.dim, block.group);
    entities.push_back({block.dim, block.entity, block.group});
  }
  const MshGroups groups = number_msh_groups(keys);
  for (HexBlock& block : blocks) block.group_tag = groups.tags.at({block.dim, block.group});
  write_file_atomically(path, [&](std::ostream& stream) {
    MshNumbers out(stream, binary);
    write_msh_header(out, binary);
    write_msh_groups(out, groups);
    write_hex_entities(out, blocks);
    write_hex_nodes(out, mesh, blocks);
    write_hex_elements(out, blocks);
    out.flush();
    write_more_names(stream, entities);
    write_msh_unit(stream, mesh.unit);
  });
}

}  // namespace delquad
