// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/library_file.h"
#include "io/library_format.h"

#include <exodusII.h>

namespace delquad {

namespace {

constexpr int kExodusNameLength = 80;
/// The number of a side: the last ones are those that are Abaqus's first, one or two opposite ones.
int exodus_side(const SolidShape& shape, int side) {
  const int n = static_cast<int>(shape.sides.size()), n_last = shape.n_corners > 5 ? 2 : 1;
  return (side + n - n_last) % n + 1;
}
/// Ends of names of blocks, which tell shapes apart that have one name.
constexpr std::array<const char*, kCellShapes> kSuffixes = {"", "",        "",          "_quads",
                                                            "", "_prisms", "_pyramids", "_tetrahedra"};

/// A file that is being written.
class ExodusFile {
 public:
  ExodusFile(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    int real_in_memory = sizeof(double), real_in_file = sizeof(double);
    ex_opts(0);  // errors are told by what is returned
    file_.id = ex_create(temporary.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &real_in_memory, &real_in_file);
    check(file_ >= 0, "the file");
    ex_set_max_name_length(file_, kExodusNameLength);
  }

  void put_head(const char* title, int dim, const std::vector<Vec3>& points, std::size_t n_elements,
                std::size_t n_blocks, int64_t n_node_sets, int64_t n_side_sets) {
    check(
        ex_put_init(file_, title, dim, static_cast<int64_t>(points.size()), static_cast<int64_t>(n_elements),
                    static_cast<int64_t>(n_blocks), n_node_sets, n_side_sets) >= 0,
        "the header");
    std::vector<double> x, y, z;
    for (const Vec3& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    check(ex_put_coord(file_, x.data(), y.data(), dim == 2 ? nullptr : z.data()) >= 0, "coordinates");
  }

  /// `nodes`: of all its elements, from 1.
  void put_block(const std::string& name, const char* type, std::size_t nodes_each,
                 const std::vector<int>& nodes) {
    block_names_.push_back(name);
    const auto id = static_cast<ex_entity_id>(block_names_.size());
    check(ex_put_block(file_, EX_ELEM_BLOCK, id, type, static_cast<int64_t>(nodes.size() / nodes_each),
                       static_cast<int64_t>(nodes_each), 0, 0, 0) >= 0,
          "a block");
    check(ex_put_conn(file_, EX_ELEM_BLOCK, id, nodes.data(), nullptr, nullptr) >= 0, "elements");
  }

  /// `nodes`: from 0.
  void put_node_set(const std::string& name, std::vector<int> nodes) {
    for (int& v : nodes) ++v;
    put_set(EX_NODE_SET, name, nodes, {}, node_sets_);
  }
  void put_side_set(const std::string& name, const std::vector<int>& elements,
                    const std::vector<int>& sides) {
    put_set(EX_SIDE_SET, name, elements, sides, side_sets_);
  }

  void close() {
    put_names(EX_ELEM_BLOCK, block_names_);
    put_names(EX_NODE_SET, node_sets_);
    put_names(EX_SIDE_SET, side_sets_);
    check(file_.close_now() >= 0, "the end of the file");
  }

 private:
  void check(bool done, const char* what) const {
    if (exerrval > 0) errno = exerrval;  // NetCDF's codes are negative, the system's positive
    require_written(done, path_, "the Exodus library", what);
  }

  void put_set(ex_entity_type type, const std::string& name, const std::vector<int>& entries,
               const std::vector<int>& extra, std::vector<std::string>& names) {
    names.push_back(name);
    const auto id = static_cast<ex_entity_id>(names.size());
    check(ex_put_set_param(file_, type, id, static_cast<int64_t>(entries.size()), 0) >= 0, "a set");
    check(ex_put_set(file_, type, id, entries.data(), extra.empty() ? nullptr : extra.data()) >= 0, "a set");
  }

  void put_names(ex_entity_type type, std::vector<std::string>& names) {
    if (names.empty()) return;
    std::vector<char*> texts;
    for (std::string& name : names) texts.push_back(name.data());
    check(ex_put_names(file_, type, texts.data()) >= 0, "names");
  }

  const std::filesystem::path& path_;
  OpenFile<int, ex_close> file_;
  std::vector<std::string> block_names_, node_sets_, side_sets_;
};

/// The elements of one name in a block of cells.
struct ExodusBlock {
  std::string name;
  const CellBlock* cells;
  std::vector<std::size_t> items;
};

class ExodusWriter {
 public:
  ExodusWriter(ExodusFile& file, const Mesh& mesh)
      : file_(file),
        mesh_(mesh),
        dim_(dimension_of(mesh)),
        groups_(mesh_groups(mesh, kExodusLabels)),
        cells_(cell_blocks(mesh)),
        number_of_(n_cells(mesh, dim_)) {}

  void write() {
    make_blocks();
    const auto n_sets = [&](int most) {
      return std::ranges::count_if(groups_, [&](const MeshGroup& g) { return g.dim <= most; });
    };
    file_.put_head(dim_ == 3 ? "Volume mesh by Delquad" : "Quad mesh by Delquad",
                   dim_ == 2 && is_planar(mesh_) ? 2 : 3, mesh_.points, number_of_.size(), blocks_.size(),
                   n_sets(dim_ - 1), n_sets(dim_ - 1) - n_sets(dim_ - 2));
    write_blocks();
    write_sets();
    file_.close();
  }

 private:
  void make_blocks() {
    int n = 0;
    for (const MeshGroup& group : groups_)
      for (const CellBlock& cells : cells_) {
        if (group.dim != dim_) continue;
        ExodusBlock block{group.label, &cells, items_in_block(group, cells)};
        if (block.items.empty()) continue;
        if (std::ranges::count(blocks_, block.name, &ExodusBlock::name) > 0)
          block.name += kSuffixes[static_cast<std::size_t>(cells.shape)];
        for (const std::size_t i : block.items) number_of_[cells.first + i] = ++n;
        blocks_.push_back(std::move(block));
      }
  }

  void write_blocks() {
    using enum CellShape;
    constexpr CellCode<const char*> kTypes[] = {
        {kTriangle, 3, "TRI3"}, {kQuad, 4, "QUAD4"},      {kQuad, 9, "QUAD9"},       {kHexahedron, 8, "HEX8"},
        {kPrism, 6, "WEDGE"},   {kPyramid, 5, "PYRAMID"}, {kTetrahedron, 4, "TETRA"}};
    for (const ExodusBlock& block : blocks_) {
      std::vector<int> nodes;
      for (const std::size_t i : block.items)
        for (const int v : block.cells->nodes(i)) nodes.push_back(v + 1);
      file_.put_block(block.name, code_of(*block.cells, kTypes), block.cells->n_nodes, nodes);
    }
  }

  /// Node sets of all below the highest dimension, side sets of those next to it.
  void write_sets() {
    const CellSides sides(mesh_);
    for (const MeshGroup& group : groups_) {
      if (group.dim == dim_) continue;
      file_.put_node_set(group.label, nodes_of_group(mesh_, group));
      if (group.dim < dim_ - 1) continue;
      std::vector<int> elements, which;
      for (const int i : group.items)
        for (const auto& [element, side] : sides.at(i)) {
          elements.push_back(number_of_[element]);
          which.push_back(dim_ == 3 ? exodus_side(*solid_at(mesh_, element).shape, side) : side + 1);
        }
      file_.put_side_set(group.label, elements, which);
    }
  }

  ExodusFile& file_;
  const Mesh& mesh_;
  const int dim_;  ///< of the elements
  const std::vector<MeshGroup> groups_;
  const std::vector<CellBlock> cells_;
  std::vector<ExodusBlock> blocks_ = {};
  std::vector<int> number_of_;  ///< in the file, of each element
};

/// Exodus II: a block for each name of the highest dimension, node and side sets of others.
void write_exodus(const std::filesystem::path& path, const Mesh& mesh) {
  write_by_library(path, [&](const std::filesystem::path& temporary) {
    ExodusFile file(path, temporary);
    ExodusWriter(file, mesh).write();
  });
}

/// Types of elements, which begin so, with their number of nodes.
struct ExodusType {
  std::string_view name;
  int n_nodes;
  CellShape shape;
};
using enum CellShape;
constexpr ExodusType kTypesToRead[] = {
    {"TRI", 3, kTriangle},    {"SHELL", 3, kTriangle},  {"QUAD", 4, kQuad},        {"QUAD", 8, kQuad},
    {"QUAD", 9, kQuad},       {"SHELL", 4, kQuad},      {"SHELL", 8, kQuad},       {"SHELL", 9, kQuad},
    {"HEX", 8, kHexahedron},  {"HEX", 20, kHexahedron}, {"HEX", 27, kHexahedron},  {"WEDGE", 6, kPrism},
    {"WEDGE", 15, kPrism},    {"PYRAMID", 5, kPyramid}, {"PYRAMID", 13, kPyramid}, {"TET", 4, kTetrahedron},
    {"TET", 10, kTetrahedron}};

class ExodusReader {
 public:
  ExodusReader(const std::filesystem::path& path, ReadNotes* notes) : path_(path), notes_(notes) {
    ex_opts(0);
    int real_in_memory = sizeof(double), real_in_file = 0;
    float version = 0;
    file_.id = ex_open(path.c_str(), EX_READ, &real_in_memory, &real_in_file, &version);
    check(file_, "an Exodus file");
    ex_set_max_name_length(file_, kExodusNameLength);
    check(ex_get_init_ext(file_, &head_), "its header");
  }

  Mesh read() {
    read_points();
    read_blocks();
    if (n_cells(mesh_, 2) + n_cells(mesh_, 3) == 0)
      refuse("{}: the file holds no triangles, quads or cells", path_.string());
    if (is_curved_ && notes_ != nullptr) notes_->push_back(kCornersOfCells);
    read_side_sets();
    read_node_sets();
    take_numbers(mesh_);
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  struct Block {
    const ExodusType* type;
    std::size_t n_nodes;  ///< of each element
    std::vector<int> nodes;
  };

  void check(int status, const std::string& what) const {
    if (status < 0)
      refuse("{}: the Exodus library cannot read {}: expected a whole file", path_.string(), what);
  }
  /// Returns an index of what the file counts from 1.
  std::size_t index(int number, std::size_t n, const char* what) const {
    if (number < 1 || static_cast<std::size_t>(number) > n)
      refuse("{}: there is no {} {}: the last one is {}", path_.string(), what, number, n);
    return static_cast<std::size_t>(number) - 1;
  }

  /// Returns the number and the name of each block or set.
  std::vector<std::pair<ex_entity_id, std::string>> list(ex_entity_type type, int64_t n) const {
    std::vector<int> ids(static_cast<std::size_t>(n));
    std::vector<std::string> texts(ids.size(), std::string(kExodusNameLength + 1, '\0'));
    std::vector<char*> names;
    for (std::string& text : texts) names.push_back(text.data());
    std::vector<std::pair<ex_entity_id, std::string>> all;
    if (n == 0) return all;
    check(ex_get_ids(file_, type, ids.data()), "numbers");
    check(ex_get_names(file_, type, names.data()), "names");
    for (std::size_t i = 0; i < ids.size(); ++i) all.emplace_back(ids[i], texts[i].c_str());
    return all;
  }

  /// Returns the index of the entity that has a name; those without one are told apart by their numbers.
  int entity(int dim, const std::string& name, ex_entity_id id) {
    std::vector<Entity>& entities = entities_of(mesh_, dim);
    const auto [at, is_new] =
        entity_of_.try_emplace({dim, name, name.empty() ? id : 0}, static_cast<int>(entities.size()));
    if (is_new) entities.push_back({at->second + 1, {}});
    if (is_new && !name.empty()) entities.back().names = {name};
    return at->second;
  }

  void read_points() {
    std::vector<double> x(static_cast<std::size_t>(head_.num_nodes)), y = x, z = x;
    check(ex_get_coord(file_, x.data(), y.data(), head_.num_dim > 2 ? z.data() : nullptr), "coordinates");
    for (std::size_t i = 0; i < x.size(); ++i) mesh_.points.push_back({x[i], y[i], z[i]});
    check_strays(mesh_, Strays::kRefused,
                 [&](int i) { return fmt::format("{}: node {}", path_.string(), i + 1); });
  }

  void read_blocks() {
    std::string before;
    for (auto [id, name] : list(EX_ELEM_BLOCK, head_.num_elem_blk)) {
      ex_block block{};
      block.id = id;
      block.type = EX_ELEM_BLOCK;
      check(ex_get_block_param(file_, &block), "a block");
      const auto n_nodes = static_cast<int>(block.num_nodes_per_entry);
      const std::string kind = upper(block.topology);
      const auto* type = std::ranges::find_if(kTypesToRead, [&](const ExodusType& t) {
        return kind.starts_with(t.name) && t.n_nodes == n_nodes;
      });
      const bool is_read = type != std::end(kTypesToRead);
      if (!is_read && block.num_entry > 0 && notes_ != nullptr)
        notes_->push_back(
            fmt::format("elements {} of {} nodes are not read: {}", kind, n_nodes, block.num_entry));
      Block read{is_read ? type : nullptr, static_cast<std::size_t>(n_nodes), {}};
      read.nodes.resize(static_cast<std::size_t>(block.num_entry) * read.n_nodes);
      if (!read.nodes.empty())
        check(ex_get_conn(file_, EX_ELEM_BLOCK, id, read.nodes.data(), nullptr, nullptr), "elements");
      for (const std::string suffix : kSuffixes)  // as the writer parts shapes
        if (!suffix.empty() && name == before + suffix) name = before;
      before = name;
      add(read, name, id, static_cast<std::size_t>(block.num_entry));
    }
  }

  void add(Block& block, const std::string& name, ex_entity_id id, std::size_t n_elements) {
    for (int& v : block.nodes) v = static_cast<int>(index(v, mesh_.points.size(), "node"));
    blocks_.push_back(std::move(block));
    const Block& added = blocks_.back();
    for (std::size_t i = 0; i < n_elements; ++i) {
      elements_.emplace_back(blocks_.size() - 1, i);
      if (added.type == nullptr) continue;
      const CellShape shape = added.type->shape;
      is_curved_ |= has_further(shape, added.n_nodes);
      if (const std::string wrong =
              add_element(mesh_, shape, nodes_of(added, i), entity(dimension_of(shape), name, id));
          !wrong.empty())
        refuse("{}: block {}: {}", path_.string(), name, wrong);
    }
  }

  static std::span<const int> nodes_of(const Block& block, std::size_t i) {
    return std::span(block.nodes).subspan(i * block.n_nodes, block.n_nodes);
  }

  /// Sides of triangles and quads become lines, sides of cells faces.
  void read_side_sets() {
    for (const auto& [id, name] : list(EX_SIDE_SET, head_.num_side_sets)) {
      side_sets_.insert(name);
      std::set<std::vector<int>> done;  // sides of two elements are there twice
      const auto [elements, sides] = set_of(EX_SIDE_SET, id, true);
      for (std::size_t i = 0; i < elements.size(); ++i) {
        const auto& [b, e] = elements_[index(elements[i], elements_.size(), "element")];
        if (blocks_[b].type == nullptr) continue;
        std::vector<int> nodes = nodes_of_side(blocks_[b], e, sides[i]), key = nodes;
        std::ranges::sort(key);
        if (nodes.empty() || !done.insert(key).second) continue;
        const bool is_face = dimension_of(blocks_[b].type->shape) == 3;
        if (const std::string wrong = add_element(mesh_, is_face ? static_cast<int>(nodes.size()) : 2, nodes,
                                                  entity(is_face ? 2 : 1, name, id));
            !wrong.empty())
          refuse("{}: side set {}: {}", path_.string(), name, wrong);
      }
    }
  }

  /// None for the top and the bottom of a shell, which are its sides 1 and 2.
  std::vector<int> nodes_of_side(const Block& block, std::size_t element, int number) const {
    const std::span<const int> v = nodes_of(block, element);
    const auto n = static_cast<std::size_t>(corners_of(block.type->shape));
    if (dimension_of(block.type->shape) == 3) {
      const SolidShape& shape = solid_shape(block.type->shape);
      index(number, shape.sides.size(), "side");
      int side = 0;
      while (exodus_side(shape, side) != number) ++side;
      const auto nodes = Solid{&shape, v}.side(side);
      return {nodes.begin(), nodes.end() - (nodes[3] < 0 ? 1 : 0)};
    }
    if (block.type->name == "SHELL" && number <= 2) return {};
    const std::size_t k = index(block.type->name == "SHELL" ? number - 2 : number, n, "side");
    std::vector<int> nodes = {v[k], v[(k + 1) % n]};
    if (v.size() > n) nodes.push_back(v[n + k]);
    return nodes;
  }

  /// Nodes become named points, unless a set of sides has their name.
  void read_node_sets() {
    NamedPoints points;
    for (const auto& [id, name] : list(EX_NODE_SET, head_.num_node_sets))
      if (!name.empty() && !side_sets_.contains(name))
        for (const int v : set_of(EX_NODE_SET, id, false).first)
          points.add(mesh_, static_cast<int>(index(v, mesh_.points.size(), "node")), name);
  }

  std::pair<std::vector<int>, std::vector<int>> set_of(ex_entity_type type, ex_entity_id id,
                                                       bool has_extra) const {
    int n = 0, n_factors = 0;
    check(ex_get_set_param(file_, type, id, &n, &n_factors), "a set");
    std::vector<int> entries(static_cast<std::size_t>(n)), extra(has_extra ? entries.size() : 0);
    if (n > 0)
      check(ex_get_set(file_, type, id, entries.data(), has_extra ? extra.data() : nullptr), "a set");
    return {entries, extra};
  }

  const std::filesystem::path& path_;
  ReadNotes* notes_;
  OpenFile<int, ex_close> file_;
  ex_init_params head_{};
  Mesh mesh_;
  std::vector<Block> blocks_;
  std::vector<std::pair<std::size_t, std::size_t>> elements_;  ///< block, and place in it
  std::map<std::tuple<int, std::string, ex_entity_id>, int> entity_of_;
  std::set<std::string> side_sets_;
  bool is_curved_ = false;
};

/// Blocks become regions or volumes, side sets curves or faces, other node sets named points.
Mesh read_exodus(const std::filesystem::path& path, ReadNotes* notes, Strays) {
  return ExodusReader(path, notes).read();
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {delquad::read_exodus, delquad::write_exodus};
