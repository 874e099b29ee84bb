#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <set>

#include "io/mesh_io.h"
#include "io/text_writer.h"
#include "mesh/error.h"

namespace delquad {

namespace {

/// One entity as the file shows it.
struct Block {
  int dim;
  const Entity* entity;
  std::vector<int> nodes, lines, triangles, quads;
  Vec3 low{kMax, kMax, kMax}, high{-kMax, -kMax, -kMax};

  static constexpr double kMax = std::numeric_limits<double>::max();
  void cover(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool is_empty() const { return lines.empty() && triangles.empty() && quads.empty(); }
};

/// Sorts elements and nodes into their entities' blocks, the curves' first. A node belongs to the first curve
/// that holds it, or else to the first region.
std::vector<Block> make_blocks(const Mesh& mesh) {
  std::vector<Block> blocks;
  for (const Entity& curve : mesh.curves) blocks.push_back({1, &curve, {}, {}, {}, {}});
  for (const Entity& region : mesh.regions) blocks.push_back({2, &region, {}, {}, {}, {}});
  constexpr int kNone = std::numeric_limits<int>::max();
  std::vector<int> owner(mesh.points.size(), kNone);
  const auto add = [&](const auto& elements, const std::vector<int>& entity_of, int first_block,
                       std::vector<int> Block::*list) {
    for (size_t i = 0; i < elements.size(); ++i) {
      const int b = first_block + entity_of[i];
      (blocks[b].*list).push_back(static_cast<int>(i));
      for (const int v : elements[i]) {
        blocks[b].cover(mesh.points[v]);
        owner[v] = std::min(owner[v], b);
      }
    }
  };
  const int first_region = static_cast<int>(mesh.curves.size());
  add(mesh.lines, mesh.line_curve, 0, &Block::lines);
  add(mesh.triangles, mesh.triangle_region, first_region, &Block::triangles);
  add(mesh.quads, mesh.quad_region, first_region, &Block::quads);
  for (size_t i = 0; i < owner.size(); ++i) {
    if (owner[i] != kNone) blocks[owner[i]].nodes.push_back(static_cast<int>(i));
  }
  std::erase_if(blocks, [](const Block& block) { return block.is_empty(); });
  return blocks;
}

using Groups = std::map<std::pair<int, std::string>, int>;  // (dimension, name) -> physical tag

/// A name that is a number is that group's tag; others take the tags that are left, in order of appearance.
Groups number_groups(const std::vector<Block>& blocks) {
  Groups groups;
  std::set<int> taken;
  for (const Block& block : blocks) {
    for (const std::string& name : block.entity->names) {
      if (!fits_msh(name)) {
        throw InputError("the name '" + name +
                         "' cannot stand in an MSH file: it has a double quote or a line break");
      }
      int tag = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), tag);
      if (error != std::errc() || tag <= 0 || name != std::to_string(tag)) continue;
      groups[{block.dim, name}] = tag;
      taken.insert(tag);
    }
  }
  int next = 1;
  for (const Block& block : blocks) {
    for (const std::string& name : block.entity->names) {
      if (groups.contains({block.dim, name})) continue;
      while (taken.contains(next)) ++next;
      groups[{block.dim, name}] = next++;
    }
  }
  return groups;
}

void write_names(TextWriter& out, const Groups& groups) {
  if (groups.empty()) return;
  std::set<std::tuple<int, int, std::string>> sorted;
  for (const auto& [key, tag] : groups) sorted.insert({key.first, tag, key.second});
  out << "$PhysicalNames\n" << sorted.size() << '\n';
  for (const auto& [dim, tag, name] : sorted) out << dim << ' ' << tag << " \"" << name << "\"\n";
  out << "$EndPhysicalNames\n";
}

void write_entities(TextWriter& out, const std::vector<Block>& blocks, const Groups& groups) {
  const auto n_curves =
      std::count_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.dim == 1; });
  out << "$Entities\n0 " << n_curves << ' ' << blocks.size() - static_cast<size_t>(n_curves) << " 0\n";
  for (const Block& block : blocks) {
    out << block.entity->tag;
    for (const Vec3& p : {block.low, block.high}) out << ' ' << p.x << ' ' << p.y << ' ' << p.z;
    std::set<int> tags;
    for (const std::string& name : block.entity->names) tags.insert(groups.at({block.dim, name}));
    out << ' ' << tags.size();
    for (const int tag : tags) out << ' ' << tag;
    out << " 0\n";
  }
  out << "$EndEntities\n";
}

void write_nodes(TextWriter& out, const Mesh& mesh, const std::vector<Block>& blocks) {
  size_t count = 0;
  int last = 0;
  for (const Block& block : blocks) {
    count += block.nodes.size();
    if (!block.nodes.empty()) last = std::max(last, block.nodes.back() + 1);
  }
  out << "$Nodes\n" << blocks.size() << ' ' << count << " 1 " << last << '\n';
  for (const Block& block : blocks) {
    out << block.dim << ' ' << block.entity->tag << " 0 " << block.nodes.size() << '\n';
    for (const int i : block.nodes) out << i + 1 << '\n';
    for (const int i : block.nodes) {
      const Vec3& p = mesh.points[i];
      out << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
  }
  out << "$EndNodes\n";
}

void write_elements(TextWriter& out, const Mesh& mesh, const std::vector<Block>& blocks) {
  size_t n_blocks = 0;
  for (const Block& b : blocks) n_blocks += !b.lines.empty() + !b.triangles.empty() + !b.quads.empty();
  const size_t count = mesh.lines.size() + mesh.triangles.size() + mesh.quads.size();
  out << "$Elements\n" << n_blocks << ' ' << count << " 1 " << count << '\n';
  size_t tag = 0;
  const auto write = [&](const Block& block, const auto& elements, const std::vector<int>& list, int type) {
    if (list.empty()) return;
    out << block.dim << ' ' << block.entity->tag << ' ' << type << ' ' << list.size() << '\n';
    for (const int i : list) {
      out << ++tag;
      for (const int v : elements[i]) out << ' ' << v + 1;
      out << '\n';
    }
  };
  for (const Block& block : blocks) {
    write(block, mesh.lines, block.lines, 1);
    write(block, mesh.triangles, block.triangles, 2);
    write(block, mesh.quads, block.quads, 3);
  }
  out << "$EndElements\n";
}

}  // namespace

void write_msh(std::ostream& stream, const Mesh& mesh) {
  const std::vector<Block> blocks = make_blocks(mesh);
  const Groups groups = number_groups(blocks);
  TextWriter out(stream);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  write_names(out, groups);
  write_entities(out, blocks, groups);
  write_nodes(out, mesh, blocks);
  write_elements(out, mesh, blocks);
  out.flush();
}

void write_msh(const std::filesystem::path& path, const Mesh& mesh) {
  write_file_atomically(path, [&](std::ostream& stream) { write_msh(stream, mesh); });
}

}  // namespace delquad
