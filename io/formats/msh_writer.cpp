#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/entity_names.h"
#include "io/formats/msh.h"
#include "io/formats/msh_output.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

/// One entity as the file shows it.
struct Block {
  int dim;
  const Entity* entity;
  std::string group;
  std::vector<int> points, nodes, lines, triangles, quads;
  int group_tag = 0;
  Vec3 low{kMax, kMax, kMax}, high{-kMax, -kMax, -kMax};

  static constexpr double kMax = std::numeric_limits<double>::max();
  void cover(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool is_empty() const { return points.empty() && lines.empty() && triangles.empty() && quads.empty(); }
};

/// Lines with more than one element, which lie inside the mesh.
std::vector<char> lines_inside(const Mesh& mesh) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<char> inside;
  for (const auto& [a, b] : mesh.lines) inside.push_back(sides_of_edge(sides, a, b).size() > 1);
  return inside;
}

/// Whether each line is written.
std::vector<char> chosen_lines(const Mesh& mesh, MshCurves curves) {
  std::vector<char> chosen(mesh.lines.size(), 1);
  if (curves == MshCurves::kAll) return chosen;
  const std::vector<char> inside = lines_inside(mesh);
  for (size_t i = 0; i < chosen.size(); ++i)
    chosen[i] = !inside[i] || (curves == MshCurves::kNamed && !mesh.curves[mesh.line_curve[i]].names.empty());
  return chosen;
}

/// Sorts elements and nodes into their entities' blocks, the points' first, then the curves'. A node belongs
/// to the first block that holds it.
std::vector<Block> make_blocks(const Mesh& mesh, const std::vector<Entity>& point_entities,
                               MshCurves curves) {
  std::vector<Block> blocks;
  const auto add_blocks = [&](int dim, const std::vector<Entity>& entities) {
    const std::vector<std::string> groups = group_names(entities, dim);
    for (size_t i = 0; i < entities.size(); ++i)
      blocks.push_back({dim, &entities[i], groups[i], {}, {}, {}, {}, {}});
  };
  add_blocks(0, point_entities);
  add_blocks(1, mesh.curves);
  add_blocks(2, mesh.regions);
  constexpr int kNone = std::numeric_limits<int>::max();
  std::vector<int> owner(mesh.points.size(), kNone);
  const auto add = [&](const auto& elements, const std::vector<int>& entity_of, int first_block,
                       std::vector<int> Block::*list, const std::vector<char>* chosen = nullptr) {
    for (size_t i = 0; i < elements.size(); ++i) {
      if (chosen && !(*chosen)[i]) continue;
      const int b = first_block + entity_of[i];
      (blocks[b].*list).push_back(static_cast<int>(i));
      for (const int v : elements[i]) {
        blocks[b].cover(mesh.points[v]);
        owner[v] = std::min(owner[v], b);
      }
    }
  };
  const int first_curve = static_cast<int>(point_entities.size());
  const int first_region = first_curve + static_cast<int>(mesh.curves.size());
  const std::vector<char> chosen = chosen_lines(mesh, curves);
  for (int i = 0; i < first_curve; ++i) {
    const int v = mesh.named_points[i].point;
    blocks[i].points.push_back(v);
    blocks[i].cover(mesh.points[v]);
    owner[v] = std::min(owner[v], i);
  }
  add(mesh.lines, mesh.line_curve, first_curve, &Block::lines, &chosen);
  add(mesh.triangles, mesh.triangle_region, first_region, &Block::triangles);
  add(mesh.quads, mesh.quad_region, first_region, &Block::quads);
  const auto own = [&](const std::vector<int>& nodes, int b) {
    for (const int v : nodes) {
      blocks[b].cover(mesh.points[v]);
      owner[v] = std::min(owner[v], b);
    }
  };
  if (mesh.order > 1) {
    for (size_t i = 0; i < mesh.lines.size(); ++i)
      if (chosen[i]) own(nodes_of_line(mesh, i), first_curve + mesh.line_curve[i]);
    for (size_t i = 0; i < mesh.quads.size(); ++i)
      own(nodes_of_quad(mesh, i), first_region + mesh.quad_region[i]);
  }
  for (size_t i = 0; i < owner.size(); ++i) {
    if (owner[i] != kNone) blocks[owner[i]].nodes.push_back(static_cast<int>(i));
  }
  std::erase_if(blocks, [](const Block& block) { return block.is_empty(); });
  return blocks;
}

/// The blocks learn their groups' tags.
MshGroups number_groups(std::vector<Block>& blocks) {
  std::vector<UniqueLabels::Key> keys;
  for (const Block& block : blocks) keys.emplace_back(block.dim, block.group);
  MshGroups groups = number_msh_groups(keys);
  for (Block& block : blocks) block.group_tag = groups.tags.at({block.dim, block.group});
  return groups;
}

void write_entities(MshNumbers& out, const std::vector<Block>& blocks) {
  const auto n_of = [&](int dim) {
    return static_cast<size_t>(std::ranges::count(blocks, dim, &Block::dim));
  };
  out.line("$Entities");
  out.size(n_of(0)).size(n_of(1)).size(n_of(2)).size(0).end_line();
  for (const Block& block : blocks) {
    out.integer(block.entity->tag).point(block.low);
    if (block.dim > 0) out.point(block.high);
    out.size(1).integer(block.group_tag);
    if (block.dim > 0) out.size(0);
    out.end_line();
  }
  out.end_section("$EndEntities");
}

void write_nodes(MshNumbers& out, const Mesh& mesh, const std::vector<Block>& blocks) {
  size_t count = 0;
  int last = 0;
  for (const Block& block : blocks) {
    count += block.nodes.size();
    if (!block.nodes.empty()) last = std::max(last, block.nodes.back() + 1);
  }
  out.line("$Nodes");
  out.size(blocks.size()).size(count).size(1).size(last).end_line();
  for (const Block& block : blocks) {
    out.integer(block.dim).integer(block.entity->tag).integer(0).size(block.nodes.size()).end_line();
    for (const int i : block.nodes) out.size(i + 1).end_line();
    for (const int i : block.nodes) out.point(mesh.points[i]).end_line();
  }
  out.end_section("$EndNodes");
}

void write_elements(MshNumbers& out, const Mesh& mesh, const std::vector<Block>& blocks, QuadNodes nodes) {
  size_t n_blocks = 0, count = 0;
  for (const Block& b : blocks) {
    n_blocks += !b.points.empty() + !b.lines.empty() + !b.triangles.empty() + !b.quads.empty();
    count += b.points.size() + b.lines.size() + b.triangles.size() + b.quads.size();
  }
  out.line("$Elements");
  out.size(n_blocks).size(count).size(1).size(count).end_line();
  size_t tag = 0;
  const auto write = [&](const Block& block, const std::vector<int>& list, int type, const auto& nodes_of) {
    if (list.empty()) return;
    out.integer(block.dim).integer(block.entity->tag).integer(type).size(list.size()).end_line();
    for (const int i : list) {
      out.size(++tag);
      for (const int v : nodes_of(static_cast<size_t>(i))) out.size(v + 1);
      out.end_line();
    }
  };
  constexpr std::array kLines = {1, 8, 26, 27}, kQuads = {3, 10, 36, 37};  // Gmsh's types, by order
  const size_t order = static_cast<size_t>(mesh.order) - 1;
  constexpr int kEightNodes = 16;
  std::vector<int> places = gmsh_places(mesh.order);
  if (nodes == QuadNodes::kNoMiddle) places.pop_back();
  const int of_quads = nodes == QuadNodes::kNoMiddle ? kEightNodes : kQuads[order];
  for (const Block& block : blocks) {
    if (!block.points.empty()) {
      out.integer(0).integer(block.entity->tag).integer(15).size(1).end_line();
      out.size(++tag).size(block.points[0] + 1).end_line();
    }
    write(block, block.lines, kLines[order], [&](size_t i) { return nodes_ends_first(mesh, i); });
    write(block, block.triangles, 2, [&](size_t i) { return mesh.triangles[i]; });
    write(block, block.quads, of_quads, [&](size_t i) { return nodes_of_quad(mesh, i, places); });
  }
  out.end_section("$EndElements");
}

/// An entity whose nodes are images of those of another.
struct PeriodicLink {
  int dim, tag, master;
  const Motion* motion;
  std::vector<std::array<int, 2>> nodes;
};

/// Named points that are images of others, by the first pair that says so.
void add_point_links(const Mesh& mesh, std::vector<PeriodicLink>& links) {
  std::map<int, int> tag_of;  // of nodes
  for (const NamedPoint& named : mesh.named_points) tag_of.try_emplace(named.point, named.entity.tag);
  std::set<int> linked;
  for (const PeriodicFaces& pair : mesh.periodic_faces)
    for (const auto& [node, of] : pair.nodes)
      if (node != of && tag_of.contains(node) && tag_of.contains(of) && linked.insert(node).second)
        links.push_back({0, tag_of.at(node), tag_of.at(of), &pair.motion, {{node, of}}});
}

/// Links whose entities are written.
void write_periodic(MshNumbers& out, const Mesh& mesh, const std::vector<Block>& blocks) {
  const auto is_written = [&](int dim, const Entity& entity) {
    return std::ranges::any_of(blocks, [&](const Block& b) { return b.dim == dim && b.entity == &entity; });
  };
  std::vector<PeriodicLink> links;
  add_point_links(mesh, links);
  const auto add = [&](int dim, const Entity& image, const Entity& master, const Motion& motion,
                       const std::vector<std::array<int, 2>>& nodes) {
    if (is_written(dim, image) && is_written(dim, master))
      links.push_back({dim, image.tag, master.tag, &motion, nodes});
  };
  for (const PeriodicNodes& link : mesh.periodic)
    add(1, mesh.curves[link.curve], mesh.curves[link.master], link.motion, link.nodes);
  for (const PeriodicFaces& link : mesh.periodic_faces)
    add(2, mesh.regions[link.face], mesh.regions[link.master], link.motion, link.nodes);
  if (links.empty()) return;
  out.line("$Periodic");
  out.size(links.size()).end_line();
  for (const PeriodicLink& link : links) {
    out.integer(link.dim).integer(link.tag).integer(link.master).end_line();
    out.size(16);
    for (const double x : link.motion->matrix()) out.real(x);
    out.end_line();
    out.size(link.nodes.size()).end_line();
    for (const auto& [node, of] : link.nodes) out.size(node + 1).size(of + 1).end_line();
  }
  out.end_section("$EndPeriodic");
}

std::vector<Entity> entities_of(const std::vector<NamedPoint>& points) {
  std::vector<Entity> entities;
  for (const NamedPoint& named : points) entities.push_back(named.entity);
  return entities;
}

std::vector<std::string> renamed_in_msh(const Mesh& mesh) {
  const std::vector<Entity> point_entities = entities_of(mesh.named_points);
  std::vector<Block> blocks = make_blocks(mesh, point_entities, MshCurves::kNamed);
  std::map<std::pair<int, int>, std::string> label_of;
  for (const auto& [dim, tag, label] : number_groups(blocks).labels) label_of[{dim, tag}] = label;
  std::vector<std::string> lines;
  std::set<UniqueLabels::Key> told;
  constexpr std::array kKinds = {"point", "curve", "region"};
  for (const Block& b : blocks)
    if (const std::string& label = label_of.at({b.dim, b.group_tag});
        label != b.group && told.emplace(b.dim, b.group).second)
      lines.push_back(std::string(kKinds[b.dim]) + " \"" + one_line(b.group) + "\" is " + label);
  return lines;
}

}  // namespace

void write_msh(std::ostream& stream, const Mesh& mesh, const MshOptions& options, QuadNodes nodes) {
  const std::vector<Entity> point_entities = entities_of(mesh.named_points);
  std::vector<Block> blocks = make_blocks(mesh, point_entities, options.curves);
  const MshGroups groups = number_groups(blocks);
  MshNumbers out(stream, options.binary);
  write_msh_header(out, options.binary);
  write_msh_groups(out, groups);
  write_entities(out, blocks);
  write_nodes(out, mesh, blocks);
  write_elements(out, mesh, blocks, nodes);
  write_periodic(out, mesh, blocks);
  out.flush();
  std::vector<MshEntity> entities;
  for (const Block& block : blocks) entities.push_back({block.dim, block.entity, block.group});
  write_more_names(stream, entities);
  write_msh_unit(stream, mesh.unit);
}

void write_msh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options,
               QuadNodes nodes) {
  write_file_atomically(path, [&](std::ostream& stream) { write_msh(stream, mesh, options, nodes); });
}

MeshFormat msh_format() {
  return {.extensions = {".msh"},
          .description = "Gmsh 2.2 and 4.1, text or bytes",
          .read = [](const std::filesystem::path& path, ReadNotes* notes,
                     Strays) { return read_msh(path, nullptr, notes); },
          .write = write_msh,
          .most_order = kMostOrder,
          .write_hexahedra = write_hex_msh,
          .eight_nodes = EightNodes::kWhenAsked,
          .has_binary = true,
          .renamed = renamed_in_msh};
}

}  // namespace delquad
