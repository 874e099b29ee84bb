// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/sort_unique.h"
#include "io/cell_view.h"
#include "io/entity_names.h"
#include "io/face_reader.h"
#include "io/formats/deck.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

const std::vector<std::string>& inp_cells() {
  static const std::vector<std::string> all = {"C3D8",  "C3D8I", "C3D8R",  "C3D20", "C3D20R", "C3D4",
                                               "C3D10", "DC3D8", "DC3D20", "DC3D4", "DC3D10"};
  return all;
}

bool has_middle_nodes(const std::string& element) {
  return element.find("20") != std::string::npos || element.ends_with("10");
}

std::string inp_number(double x, double negligible) {
  if (std::abs(x) < negligible) return "0";
  constexpr std::ptrdiff_t kLongestInpNumber = 20;
  char digits[32];
  char* end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  for (int n = 17; end - digits > kLongestInpNumber; --n)
    end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr;
  return {digits, end};
}

namespace {

/// The longest name that Abaqus takes is 80; what is left is for numbers, and for names of sides.
constexpr std::size_t kLongestInpName = 60;
/// On one line of a set or an element, which may have no more.
constexpr std::size_t kInpNumbersPerLine = 16;
/// Names of the sets of all elements and of all nodes.
constexpr const char *kAllElements = "Eall", *kAllNodes = "Nall";

/// Kinds of labels: the tag or a name of an entity, by its dimension, or a set.
enum InpName { kTagOf = 0, kNameOf = 4, kSet = 8 };

/// "1, 4, 7, 9": the number of an element and the numbers of its nodes, from 1.
void write_inp_element(TextWriter& out, int number, const std::vector<int>& nodes) {
  out << number;
  std::size_t n = 1;
  for (const int v : nodes) out << (n++ % kInpNumbersPerLine == 0 ? ",\n" : ", ") << v + 1;
  out << '\n';
}

/// Sorts them first, and leaves out what is there twice.
void write_inp_numbers(TextWriter& out, std::vector<int>& numbers, std::size_t per_line) {
  sort_unique(numbers);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size() || (i + 1) % per_line == 0;
    out << numbers[i] << (last ? "\n" : ", ");
  }
}

/// Members of a set of nodes or elements by its label.
using Sets = std::map<std::string, std::vector<int>>;

void write_inp_sets(TextWriter& out, const char* keyword, Sets& sets) {
  for (auto& [label, numbers] : sets) {
    out << '*' << keyword << ", " << keyword << '=' << label << '\n';
    write_inp_numbers(out, numbers, kInpNumbersPerLine);
  }
}

/// Entities beside cells of volumes go by their names alone.
std::vector<UniqueLabels::Key> keys_of(const Entity& entity, int dim, bool is_solid) {
  std::vector<UniqueLabels::Key> keys;
  if (!is_solid) keys.emplace_back(kTagOf + dim, tag_label(dim, entity.tag));
  for (const std::string& name : entity.names) keys.emplace_back(kNameOf + dim, name);
  return keys;
}

/// Both node sets of a pair of curves or of faces: images, and what they are images of.
std::array<std::string, 2> pair_names(const char* kind, size_t pair) {
  const std::string name = kind + std::to_string(pair + 1);
  return {name, name + "_MASTER"};
}
constexpr const char *kCurvePair = "PERIODIC_", *kFacePair = "PERIODIC_FACE_";

/// Elements, from 1, by thickness to four digits.
std::map<std::string, std::vector<int>> elements_by_thickness(const Mesh& mesh) {
  std::map<std::string, std::vector<int>> elements;
  for (std::size_t e = 0; e < mesh.thickness.size(); ++e)
    elements[fmt::format("{:.4g}", mesh.thickness[e])].push_back(static_cast<int>(e) + 1);
  return elements;
}
constexpr const char* kThickness = "thickness_";

UniqueLabels make_labels(const Mesh& mesh, bool is_solid) {
  const std::vector<Entity> points = entities_of(mesh.named_points);
  const std::array all = {&points, &mesh.curves, &mesh.regions, &mesh.volumes};
  std::vector<UniqueLabels::Key> keys;
  for (const int dim : is_solid ? std::array{3, 2, 1, 0} : std::array{1, 2, 0, 3})
    for (const Entity& entity : *all[dim])
      for (auto& key : keys_of(entity, dim, is_solid)) keys.push_back(std::move(key));
  // Names that are tags keep them.
  std::ranges::stable_partition(keys, [](const auto& key) { return key.first < kNameOf; });
  for (const auto& [kind, count] :
       {std::pair{kCurvePair, mesh.periodic.size()}, std::pair{kFacePair, mesh.periodic_faces.size()}})
    for (size_t i = 0; i < count; ++i)
      for (const std::string& name : pair_names(kind, i)) keys.emplace_back(kSet, name);
  for (const auto& [thickness, elements] : elements_by_thickness(mesh))
    keys.emplace_back(kSet, kThickness + thickness);
  for (const char* set : {kAllElements, kAllNodes}) keys.emplace_back(kSet, set);
  return UniqueLabels(keys, {plain_label, true, kLongestInpName});
}

/// Returns edges of an element; cells have them in the order of the nodes of C3D20, C3D15 and C3D10.
std::vector<std::pair<int, int>> edges_of(const CellBlock& cells, const std::vector<int>& v) {
  std::vector<std::pair<int, int>> edges;
  if (cells.dim == 3)
    for (const auto& [a, b] : solid_shape(cells.shape).edges) edges.emplace_back(v[a], v[b]);
  else
    for (std::size_t k = 0; k < v.size(); ++k) edges.emplace_back(v[k], v[(k + 1) % v.size()]);
  return edges;
}

/// Types of hexahedra, prisms and tetrahedra in a mesh for which one of inp_cells() is chosen.
std::array<std::string, 3> types_of_cells(std::string element) {
  if (element.empty()) element = inp_cells()[0];
  const std::string prefix = element[0] == 'D' ? "DC3D" : "C3D";
  const bool is_quadratic = has_middle_nodes(element);
  if (element.ends_with("4") || element.ends_with("10")) element = prefix + (is_quadratic ? "20" : "8");
  return {element, prefix + (is_quadratic ? "15" : "6"), prefix + (is_quadratic ? "10" : "4")};
}

class InpWriter {
 public:
  InpWriter(TextWriter& out, const Mesh& mesh, const std::string& element)
      : out_(out),
        mesh_(mesh),
        is_solid_(is_solid(mesh)),
        // Plane elements of a face that looks down would be inverted.
        is_planar_(element != kShell && is_planar(mesh)),
        types_(types_of_cells(element)),
        cells_(cell_blocks(mesh, places_on_sides(mesh.order))),
        labels_(make_labels(mesh, is_solid_)) {
    if (!is_solid_ || !types_[1].ends_with("15")) return;
    for (const CellBlock& cells : cells_)
      for (std::size_t i = 0; i < cells.size() && cells.dim == 3; ++i)
        for (const auto& [a, b] : edges_of(cells, cells.nodes(i))) edges_.push_back(std::minmax({a, b}));
    sort_unique(edges_);
  }

  void write() {
    write_head();
    write_nodes();
    write_elements();
    for (const CellBlock& cells : cells_) collect(cells);
    Sets by_thickness = elements_by_thickness(mesh_);
    for (auto& [thickness, elements] : by_thickness)
      add(element_sets_, labels_.of({kSet, kThickness + thickness}), elements);
    for (const NamedPoint& named : mesh_.named_points)
      for (const std::string& label : labels_of(named.entity, 0)) add(node_sets_, label, {named.point + 1});
    for (auto* sets : {&element_sets_, &sides_}) write_inp_sets(out_, "ELSET", *sets);
    collect_pairs(kCurvePair, mesh_.periodic);
    collect_pairs(kFacePair, mesh_.periodic_faces);
    write_inp_sets(out_, "NSET", node_sets_);
    write_pairs(kCurvePair, mesh_.periodic);
    write_pairs(kFacePair, mesh_.periodic_faces);
    write_surfaces();
    if (!by_thickness.empty()) out_ << "** *MATERIAL, NAME=SHEET stands before this file\n";
    for (const auto& [thickness, elements] : by_thickness)
      out_ << "*SHELL SECTION, ELSET=" << labels_.of({kSet, kThickness + thickness}) << ", MATERIAL=SHEET\n"
           << thickness << '\n';
  }

 private:
  void write_head() {
    const std::array kKinds = {"point", "curve", is_solid_ ? "face" : "region", "volume", "set"};
    out_ << "*HEADING\n" << (is_solid_ ? "Volume mesh" : "Quad mesh") << " by Delquad\n";
    if (!mesh_.unit.empty()) out_ << "** lengths in " << mesh_.unit << '\n';
    for (const auto& [key, label] : labels_.renamed())
      out_ << "** " << (key.first < kNameOf ? "" : kKinds[key.first - kNameOf]) << " \""
           << one_line(key.second) << "\" is " << label << '\n';
  }

  /// The node inside of a quad has no place in elements of Abaqus.
  void write_nodes() {
    // A part of the model's diagonal: rotations and projections turn zeros into some hundred steps of a
    // double.
    constexpr double kNegligible = 1e-13;
    const double negligible = kNegligible * diagonal(mesh_.points);
    const std::vector<char> left_out = are_in_middles(mesh_);
    out_ << "*NODE, NSET=" << labels_.of({kSet, kAllNodes}) << '\n';
    const auto write = [&](std::size_t i, const Vec3& p) {
      out_ << i + 1;
      for (const double x : {p.x, p.y, p.z}) out_ << ", " << inp_number(x, negligible);
      out_ << '\n';
    };
    for (std::size_t i = 0; i < mesh_.points.size(); ++i)
      if (!left_out[i]) write(i, mesh_.points[i]);
    for (std::size_t i = 0; i < edges_.size(); ++i)
      write(mesh_.points.size() + i, middle_of_edge(mesh_, edges_[i].first, edges_[i].second));
  }

  void write_elements() {
    using enum CellShape;
    const CellCode<std::string> types[] = {{kTriangle, 3, is_planar_ ? "CPS3" : "S3"},
                                           {kQuad, 4, is_planar_ ? "CPS4" : "S4"},
                                           {kQuad, 8, is_planar_ ? "CPS8" : "S8R"},
                                           {kHexahedron, 8, types_[0]},
                                           {kPrism, 6, types_[1]},
                                           {kTetrahedron, 4, types_[2]}};
    int n = 0;
    for (const CellBlock& cells : cells_) {
      if (cells.dim != dimension_of(mesh_)) continue;
      out_ << "*ELEMENT, TYPE=" << code_of(cells, types) << ", ELSET=" << labels_.of({kSet, kAllElements})
           << '\n';
      for (size_t i = 0; i < cells.size(); ++i) write_inp_element(out_, ++n, nodes_of(cells, i));
    }
  }

  /// With the middles of edges, if they have nodes.
  std::vector<int> nodes_of(const CellBlock& cells, std::size_t i) const {
    std::vector<int> nodes = cells.nodes(i);
    if (edges_.empty()) return nodes;
    for (const auto& [a, b] : edges_of(cells, cells.nodes(i))) {
      const auto at = std::ranges::lower_bound(edges_, std::pair(std::minmax({a, b})));
      nodes.push_back(static_cast<int>(mesh_.points.size()) + static_cast<int>(at - edges_.begin()));
    }
    return nodes;
  }

  std::vector<std::string> labels_of(const Entity& entity, int dim) const {
    std::vector<std::string> all;
    for (const auto& key : keys_of(entity, dim, is_solid_)) all.push_back(labels_.of(key));
    return all;
  }

  static void add(Sets& sets, const std::string& label, const std::vector<int>& numbers) {
    std::vector<int>& all = sets[label];
    all.insert(all.end(), numbers.begin(), numbers.end());
  }

  /// Nodes of entities, and their elements if these have the highest dimension.
  void collect(const CellBlock& cells) {
    std::vector<std::vector<int>> elements(cells.entities->size()), nodes(cells.entities->size());
    for (size_t i = 0; i < cells.size(); ++i) {
      const int entity = (*cells.entity_of)[i];
      elements[entity].push_back(static_cast<int>(cells.first + i) + 1);
      for (const int v : nodes_of(cells, i)) nodes[entity].push_back(v + 1);
    }
    for (size_t e = 0; e < elements.size(); ++e)
      for (const std::string& label : labels_of((*cells.entities)[e], cells.dim)) {
        if (elements[e].empty()) continue;
        add(node_sets_, label, nodes[e]);
        if (cells.dim == dimension_of(mesh_)) add(element_sets_, label, elements[e]);
      }
    if (cells.dim == dimension_of(mesh_) - 1) collect_sides(cells);
  }

  /// Sides on the boundary, "S2", or of shells "E2".
  void collect_sides(const CellBlock& cells) {
    const CellSides sides(mesh_);
    for (size_t i = 0; i < cells.size(); ++i) {
      const auto at = sides.at(static_cast<int>(cells.first + i));
      if (at.size() != 1) continue;
      std::vector<int> nodes = cells.nodes(i);
      for (int& v : nodes) ++v;
      const std::string side = (is_solid_ || is_planar_ ? "S" : "E") + std::to_string(at[0].side + 1);
      for (const std::string& label : labels_of(cells.entity(i), cells.dim)) {
        add(surface_nodes_, label, nodes);
        add(is_solid_ ? element_sets_ : sides_, "_" + label + "_" + side, {at[0].element + 1});
        sides_of_[label].insert(side);
      }
    }
  }

  template <class Pair>
  void collect_pairs(const char* kind, const std::vector<Pair>& pairs) {
    for (size_t i = 0; i < pairs.size(); ++i)
      for (const auto& nodes : pairs[i].nodes)
        for (const int side : {0, 1})
          add(node_sets_, labels_.of({kSet, pair_names(kind, i)[side]}), {nodes[side] + 1});
  }

  /// Which node is the image of which. Sets have no order in both programs (CalculiX knows no UNSORTED), and
  /// equations of CalculiX take nodes one by one.
  template <class Pair>
  void write_pairs(const char* kind, const std::vector<Pair>& pairs) {
    for (size_t i = 0; i < pairs.size(); ++i)
      for (const auto& nodes : pairs[i].nodes)
        out_ << "** " << labels_.of({kSet, pair_names(kind, i)[0]}) << ": " << nodes[0] + 1 << ", "
             << nodes[1] + 1 << '\n';
  }

  /// Abaqus and CalculiX call the sides of shells by different names, but both know surfaces of nodes.
  void write_surfaces() {
    const bool are_of_nodes = !is_solid_ && !is_planar_;
    for (auto& [label, nodes] : surface_nodes_) {
      out_ << "*SURFACE, NAME=" << label << ", TYPE=" << (are_of_nodes ? "NODE" : "ELEMENT") << '\n';
      if (are_of_nodes) write_inp_numbers(out_, nodes, 1);
      for (const std::string& side : sides_of_[label])
        if (!are_of_nodes) out_ << '_' << label << '_' << side << ", " << side << '\n';
    }
  }

  TextWriter& out_;
  const Mesh& mesh_;
  const bool is_solid_, is_planar_;
  const std::array<std::string, 3> types_;
  const std::vector<CellBlock> cells_;
  const UniqueLabels labels_;
  std::vector<std::pair<int, int>> edges_;  ///< of cells, with a node in the middle; sorted
  Sets element_sets_, node_sets_, sides_, surface_nodes_;
  std::map<std::string, std::set<std::string>> sides_of_;
};

/// Writes Abaqus input that CalculiX takes, too: numbers of at most 20 characters, shells S4 and S3. Elements
/// are CPS4 and CPS3 if all z are equal, they turn left and the options do not say S4. All elements are in
/// "Eall", all nodes in "Nall".
/// Every region is an ELSET and an NSET, every curve an NSET and a SURFACE. They go by tag ("region_3",
/// "curve_5") and by each name, in letters, digits and underscores; comments have the table. A curve's
/// surface has the sides of plane elements, and the nodes of shells. Sides of shells are ELSETs for edge
/// loads ("_curve_5_E2"). Beside cells of volumes every name is an NSET. Names of volumes are ELSETs, too,
/// and names of faces on the boundary SURFACEs.
void write_inp(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  require_numbers(path, "Abaqus", mesh, 999'999'999);
  write_text_file(path, [&](TextWriter& out) { InpWriter(out, mesh, options.element).write(); });
}

}  // namespace

MeshFormat inp_format() {
  return {.extensions = {".inp"},
          .description = "Abaqus, CalculiX",
          .read =
              [](const std::filesystem::path& path, ReadNotes* notes, Strays) {
                Deck deck = read_inp_deck(path, false);
                for (const auto& [other, count] : deck.others)
                  if (notes != nullptr && other.starts_with("*ELEMENT"))
                    notes->push_back(other + " is not read");
                if (notes != nullptr && std::ranges::any_of(deck.elements, [](const Deck::Element& e) {
                      return has_further(e.shape(), e.nodes.size());
                    }))
                  notes->push_back(kCornersOfCells);
                return std::move(deck.mesh);
              },
          .write = write_inp,
          .most_order = 2,
          .has_cells = true,
          .has_pyramids = false,
          .eight_nodes = EightNodes::kAlways,
          .names = kAllNames | kFurtherNames | kPeriodicPairs,
          .read_given = [](const std::filesystem::path& path,
                           ReadNotes* notes) { return given_mesh(read_inp_deck(path, true), notes); },
          .rewrite = rewrite_inp,
          .sections = inp_sections,
          .add_sections = add_inp_sections,
          .others = [](const std::filesystem::path& path) { return read_inp_deck(path, false).others; }};
}

}  // namespace delquad
