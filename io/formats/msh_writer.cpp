// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "base/box.h"
#include "io/cell_view.h"
#include "io/formats/msh.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

/// Numbers as text, separated by blanks, or as bytes.
class MshNumbers {
 public:
  MshNumbers(std::ostream& stream, bool binary) : out_(stream), binary_(binary) {}

  MshNumbers& integer(int value) { return put(value); }
  MshNumbers& size(size_t value) { return put(static_cast<std::uint64_t>(value)); }
  MshNumbers& real(double value) { return put(value); }
  MshNumbers& point(const Vec3& p) { return real(p.x).real(p.y).real(p.z); }
  void end_line() {
    if (!binary_) out_ << '\n';
    at_start_ = true;
  }
  void line(std::string_view text) { out_ << text << '\n'; }
  void end_section(std::string_view name) {
    if (binary_) out_ << '\n';
    line(name);
  }
  void flush() { out_.flush(); }

 private:
  template <class T>
  MshNumbers& put(T value) {
    if (binary_) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      out_ << std::string_view(bytes, sizeof value);
      return *this;
    }
    if (!at_start_) out_ << ' ';
    at_start_ = false;
    out_ << value;
    return *this;
  }

  TextWriter out_;
  bool binary_, at_start_ = true;
};

/// One entity as the file shows it.
struct MshBlock {
  int dim;
  const Entity* entity;
  std::string group;
  int group_tag = 0;
  std::vector<std::pair<const CellBlock*, std::vector<size_t>>> elements = {};
  std::vector<int> nodes = {};  ///< that no entity before has
  Box<Vec3> box{{kMax, kMax, kMax}, {-kMax, -kMax, -kMax}};

  static constexpr double kMax = std::numeric_limits<double>::max();
};

/// Sorts elements and nodes into the blocks of their entities. A node belongs to the first block that holds
/// it. `is_chosen`: whether each line is written.
std::vector<MshBlock> make_blocks(const std::vector<Vec3>& points, const std::vector<CellBlock>& all,
                                  const std::vector<char>& is_chosen) {
  std::vector<MshBlock> blocks;
  constexpr int kNone = std::numeric_limits<int>::max();
  std::vector<int> owner(points.size(), kNone);
  int first = 0;  // block of the dimension
  for (const CellBlock& cells : all) {
    if (blocks.empty() || blocks.back().dim != cells.dim) {
      first = static_cast<int>(blocks.size());
      const std::vector<std::string> groups = group_names(*cells.entities, cells.dim);
      for (size_t i = 0; i < groups.size(); ++i)
        blocks.push_back({cells.dim, &(*cells.entities)[i], groups[i]});
    }
    for (size_t i = 0; i < cells.size(); ++i) {
      if (cells.shape == CellShape::kLine && !is_chosen[i]) continue;
      const int b = first + (*cells.entity_of)[i];
      MshBlock& block = blocks[b];
      if (block.elements.empty() || block.elements.back().first != &cells)
        block.elements.push_back({&cells, {}});
      block.elements.back().second.push_back(i);
      for (const int v : cells.nodes(i)) {
        block.box.add(points[v]);
        owner[v] = std::min(owner[v], b);
      }
    }
  }
  for (size_t i = 0; i < owner.size(); ++i)
    if (owner[i] != kNone) blocks[owner[i]].nodes.push_back(static_cast<int>(i));
  std::erase_if(blocks, [](const MshBlock& block) { return block.elements.empty(); });
  return blocks;
}

/// Names as they can stand between quotes, without control characters; Gmsh reads lines of up to 255 bytes.
std::string quotable(const std::string& name) {
  std::string label = name;
  for (char& c : label) {
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return label;
}

/// Physical groups as files have them: dimension, number, label.
using MshGroups = std::set<std::tuple<int, int, std::string>>;

/// The blocks learn their groups' tags. A name that is a number is that group's number; others take those
/// that are left, in order of appearance.
MshGroups number_groups(std::vector<MshBlock>& blocks) {
  constexpr size_t kLongestLabel = 200;
  std::vector<UniqueLabels::Key> keys;
  for (const MshBlock& block : blocks) keys.emplace_back(block.dim, block.group);
  const UniqueLabels labels(keys, {quotable, false, kLongestLabel});
  std::map<UniqueLabels::Key, int> tags;
  std::set<int> taken;
  for (const auto& key : keys) {
    int tag = 0;
    const std::string& name = key.second;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), tag);
    if (error != std::errc() || tag <= 0 || name != std::to_string(tag)) continue;
    tags[key] = tag;
    taken.insert(tag);
  }
  MshGroups groups;
  int next = 1;
  for (size_t i = 0; i < keys.size(); ++i) {
    const auto& key = keys[i];
    if (!tags.contains(key)) {
      while (taken.contains(next)) ++next;
      tags[key] = next++;
    }
    blocks[i].group_tag = tags[key];
    groups.insert({key.first, tags[key], labels.of(key)});
  }
  return groups;
}

void write_head(MshNumbers& out, const char* version, bool binary, const MshGroups& groups) {
  out.line("$MeshFormat");
  out.line(version + std::string(binary ? " 1 8" : " 0 8"));
  if (binary) {
    out.integer(1);
    out.line("");
  }
  out.line("$EndMeshFormat");
  if (groups.empty()) return;
  out.line("$PhysicalNames");
  out.line(std::to_string(groups.size()));
  for (const auto& [dim, tag, name] : groups)
    out.line(std::to_string(dim) + ' ' + std::to_string(tag) + " \"" + name + '"');
  out.line("$EndPhysicalNames");
}

void write_entities(MshNumbers& out, const std::vector<MshBlock>& blocks) {
  out.line("$Entities");
  for (const int dim : {0, 1, 2, 3})
    out.size(static_cast<size_t>(std::ranges::count(blocks, dim, &MshBlock::dim)));
  out.end_line();
  for (const MshBlock& block : blocks) {
    out.integer(block.entity->tag).point(block.box.low);
    if (block.dim > 0) out.point(block.box.high);
    out.size(1).integer(block.group_tag);
    if (block.dim > 0) out.size(0);
    out.end_line();
  }
  out.end_section("$EndEntities");
}

void write_nodes(MshNumbers& out, const std::vector<Vec3>& points, const std::vector<MshBlock>& blocks) {
  size_t count = 0;
  int last = 0;
  for (const MshBlock& block : blocks) {
    count += block.nodes.size();
    if (!block.nodes.empty()) last = std::max(last, block.nodes.back() + 1);
  }
  out.line("$Nodes");
  out.size(blocks.size()).size(count).size(1).size(last).end_line();
  for (const MshBlock& block : blocks) {
    out.integer(block.dim).integer(block.entity->tag).integer(0).size(block.nodes.size()).end_line();
    for (const int i : block.nodes) out.size(i + 1).end_line();
    for (const int i : block.nodes) out.point(points[i]).end_line();
  }
  out.end_section("$EndNodes");
}

int type_of(const CellBlock& cells) {
  using enum CellShape;
  constexpr CellCode<int> kTypes[] = {
      {kPoint, 1, 15},   {kLine, 2, 1},       {kLine, 3, 8},  {kLine, 4, 26},   {kLine, 5, 27},
      {kTriangle, 3, 2}, {kQuad, 4, 3},       {kQuad, 8, 16}, {kQuad, 9, 10},   {kQuad, 16, 36},
      {kQuad, 25, 37},   {kHexahedron, 8, 5}, {kPrism, 6, 6}, {kPyramid, 5, 7}, {kTetrahedron, 4, 4}};
  return code_of(cells, kTypes);
}

void write_elements(MshNumbers& out, const std::vector<MshBlock>& blocks) {
  size_t n_blocks = 0, count = 0;
  for (const MshBlock& block : blocks) {
    n_blocks += block.elements.size();
    for (const auto& [cells, items] : block.elements) count += items.size();
  }
  out.line("$Elements");
  out.size(n_blocks).size(count).size(1).size(count).end_line();
  size_t tag = 0;
  for (const MshBlock& block : blocks)
    for (const auto& [cells, items] : block.elements) {
      out.integer(block.dim).integer(block.entity->tag).integer(type_of(*cells));
      out.size(items.size()).end_line();
      for (const size_t i : items) {
        out.size(++tag);
        for (const int v : cells->nodes(i)) out.size(v + 1);
        out.end_line();
      }
    }
  out.end_section("$EndElements");
}

/// Nodes and elements of format 2.2, which has no entities: each element has the tags of its group and its
/// entity.
void write_contents_22(MshNumbers& out, bool binary, const std::vector<Vec3>& points,
                       const std::vector<MshBlock>& blocks) {
  size_t n_nodes = 0, n_elements = 0;
  for (const MshBlock& block : blocks) {
    n_nodes += block.nodes.size();
    for (const auto& [cells, items] : block.elements) n_elements += items.size();
  }
  out.line("$Nodes\n" + std::to_string(n_nodes));
  for (const MshBlock& block : blocks)
    for (const int i : block.nodes) out.integer(i + 1).point(points[i]).end_line();
  out.end_section("$EndNodes");
  out.line("$Elements\n" + std::to_string(n_elements));
  int tag = 0;
  for (const MshBlock& block : blocks)
    for (const auto& [cells, items] : block.elements) {
      const int type = type_of(*cells);
      if (binary) out.integer(type).integer(static_cast<int>(items.size())).integer(2);
      for (const size_t i : items) {
        out.integer(++tag);
        if (!binary) out.integer(type).integer(2);
        out.integer(block.group_tag).integer(block.entity->tag);
        for (const int v : cells->nodes(i)) out.integer(v + 1);
        out.end_line();
      }
    }
  out.end_section("$EndElements");
}

/// An entity whose nodes are images of another one's nodes.
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
void write_periodic(MshNumbers& out, const Mesh& mesh, const std::vector<MshBlock>& blocks) {
  const auto is_written = [&](int dim, const Entity& entity) {
    return std::ranges::any_of(blocks,
                               [&](const MshBlock& b) { return b.dim == dim && b.entity == &entity; });
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

/// Names of entities beside their groups, which other programs skip.
void write_more_names(std::ostream& stream, const std::vector<MshBlock>& blocks) {
  TextWriter out(stream);
  std::vector<std::pair<const MshBlock*, std::string>> all;
  for (const MshBlock& block : blocks)
    for (const std::string& name : block.entity->names)
      if (name != block.group) all.emplace_back(&block, quotable(name));
  if (all.empty()) return;
  out << "$MoreNames\n" << all.size() << '\n';
  for (const auto& [block, name] : all)
    out << block->dim << ' ' << block->entity->tag << " \"" << name << "\"\n";
  out << "$EndMoreNames\n";
  out.flush();
}

/// Vectors of the plane get a third component, for Gmsh knows 1, 3 and 9; a NaN is not written.
void write_views(MshNumbers& out, const std::vector<MshBlock>& blocks, const std::vector<MeshField>& fields,
                 int dim) {
  for (const MeshField& field : fields) {
    const auto width = static_cast<std::size_t>(field.n_components);
    const std::size_t written = width == 2 ? 3 : width;
    std::vector<std::pair<int, const double*>> rows;  // by tag
    const auto add = [&](int tag, std::size_t i) {
      const double* const row = &field.values[width * i];
      if (!std::isnan(*row)) rows.emplace_back(tag, row);
    };
    int tag = 0;
    for (const MshBlock& block : blocks) {
      if (field.is_of_points)
        for (const int i : block.nodes) add(i + 1, i);
      else
        for (const auto& [cells, items] : block.elements)
          for (const std::size_t i : items)
            if (++tag; block.dim == dim) add(tag, cells->first + i);
    }
    const std::string section = field.is_of_points ? "NodeData" : "ElementData";
    // One text, one time, and three numbers: of the step, of components and of values.
    out.line("$" + section + "\n1\n\"" + quotable(field.name) + "\"\n1\n0\n3\n0\n" + std::to_string(written) +
             "\n" + std::to_string(rows.size()));
    for (const auto& [number, row] : rows) {
      out.integer(number);
      for (std::size_t k = 0; k < written; ++k) out.real(k < width ? row[k] : 0);
      out.end_line();
    }
    out.end_section("$End" + section);
  }
}

void write_blocks(std::ostream& stream, bool binary, bool is_22, const Mesh& mesh,
                  std::vector<MshBlock> blocks, const std::vector<MeshField>& fields) {
  MshNumbers out(stream, binary);
  write_head(out, is_22 ? "2.2" : "4.1", binary, number_groups(blocks));
  if (is_22) {
    write_contents_22(out, binary, mesh.points, blocks);
  } else {
    write_entities(out, blocks);
    write_nodes(out, mesh.points, blocks);
    write_elements(out, blocks);
    write_periodic(out, mesh, blocks);
  }
  write_views(out, blocks, fields, dimension_of(mesh));
  out.flush();
  write_more_names(stream, blocks);
  if (!mesh.unit.empty()) stream << "$Unit\n" << mesh.unit << "\n$EndUnit\n";
}

/// Whether each line is written.
std::vector<char> chosen_lines(const Mesh& mesh, MshCurves curves) {
  std::vector<char> chosen(mesh.lines.size(), 1);
  if (curves == MshCurves::kAll) return chosen;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (size_t i = 0; i < chosen.size(); ++i) {
    const bool is_inside = sides_of_edge(sides, mesh.lines[i][0], mesh.lines[i][1]).size() > 1;
    const bool is_named = !mesh.curves[mesh.line_curve[i]].names.empty();
    chosen[i] = !is_inside || (curves == MshCurves::kNamed && is_named);
  }
  return chosen;
}

/// Calls visit(blocks), which live as long.
template <class Visit>
void with_blocks(const Mesh& mesh, MshCurves curves, const Visit& visit) {
  const std::vector<Entity> points = entities_of(mesh.named_points);
  std::vector<int> of_points(points.size());
  std::iota(of_points.begin(), of_points.end(), 0);
  std::vector<CellBlock> all = cell_blocks(mesh);
  all.insert(all.begin(), {CellShape::kPoint, 0, 1, 0, &of_points, &points,
                           [&](size_t i) { return std::vector{mesh.named_points[i].point}; }});
  visit(make_blocks(mesh.points, all, chosen_lines(mesh, curves)));
}

std::vector<std::string> renamed_in_msh(const Mesh& mesh) {
  std::vector<std::string> lines;
  with_blocks(mesh, MshCurves::kNamed, [&](std::vector<MshBlock> blocks) {
    std::map<std::pair<int, int>, std::string> label_of;
    for (const auto& [dim, tag, label] : number_groups(blocks)) label_of[{dim, tag}] = label;
    std::set<UniqueLabels::Key> reported;
    const std::array kKinds = {"point", "curve", is_solid(mesh) ? "face" : "region", "volume"};
    for (const MshBlock& b : blocks)
      if (const std::string& label = label_of.at({b.dim, b.group_tag});
          label != b.group && reported.emplace(b.dim, b.group).second)
        lines.push_back(std::string(kKinds[b.dim]) + " \"" + one_line(b.group) + "\" is " + label);
  });
  return lines;
}

}  // namespace

void write_msh(std::ostream& stream, const Mesh& mesh, const MshOptions& options,
               const std::vector<MeshField>& fields, bool is_22) {
  with_blocks(mesh, options.curves, [&](std::vector<MshBlock> blocks) {
    write_blocks(stream, options.binary, is_22, mesh, std::move(blocks), fields);
  });
}

void write_msh(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  std::vector<MeshField> fields;
  if (!mesh.thickness.empty()) fields.push_back({"thickness", false, 1, mesh.thickness});
  write_file_atomically(path, [&](std::ostream& stream) {
    write_msh(stream, mesh, options, fields, options.is_msh22 || path.extension() == ".msh2");
  });
}

MeshFormat msh_format() {
  return {.extensions = {".msh", ".msh2"},
          .description = "Gmsh 4.1, .msh2: 2.2; text or bytes",
          .read = [](const std::filesystem::path& path, ReadNotes* notes,
                     Strays) { return read_msh(path, nullptr, notes); },
          .write = write_msh,
          .most_order = kMostOrder,
          .has_cells = true,
          .eight_nodes = EightNodes::kOnRequest,
          .has_binary = true,
          .renamed = renamed_in_msh,
          .names = kAllNames | kFurtherNames | kPeriodicPairs};
}

}  // namespace delquad
