#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/sort_unique.h"
#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/entity_names.h"
#include "io/formats/deck.h"
#include "io/formats/readers.h"
#include "io/hex_sides.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

const std::vector<std::string>& inp_hexahedra() {
  static const std::vector<std::string> all = {"C3D8",   "C3D8I", "C3D8R", "C3D20",
                                               "C3D20R", "DC3D8", "DC3D20"};
  return all;
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

// What Abaqus input files have in common, whatever elements they hold.

/// The longest name that Abaqus takes is 80; what is left is for numbers, and for names of sides.
constexpr std::size_t kLongestInpName = 60;
/// On one line of a set or an element, which may have no more.
constexpr std::size_t kInpNumbersPerLine = 16;
/// Names of the sets of all elements and of all nodes.
constexpr const char *kAllElements = "Eall", *kAllNodes = "Nall";

/// `kinds`: what keys of labels are the names of.
void write_inp_head(TextWriter& out, const char* title, const std::string& unit, const UniqueLabels& labels,
                    std::span<const char* const> kinds) {
  out << "*HEADING\n" << title << " by Delquad\n";
  if (!unit.empty()) out << "** lengths in " << unit << '\n';
  for (const auto& [key, label] : labels.renamed())
    out << "** " << kinds[static_cast<std::size_t>(key.first)] << " \"" << one_line(key.second) << "\" is "
        << label << '\n';
}

/// Writes the nodes for which `is_written(i)` holds, as members of `set`.
template <class IsWritten>
void write_inp_nodes(TextWriter& out, const std::vector<Vec3>& points, const std::string& set,
                     IsWritten is_written) {
  // Of the model's diagonal: some hundred steps of a double there, what rotations and projections leave of
  // zeros.
  constexpr double kNegligible = 1e-13;
  const double negligible = kNegligible * diagonal(points);
  out << "*NODE, NSET=" << set << '\n';
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_written(i)) continue;
    out << i + 1;
    for (const double x : {points[i].x, points[i].y, points[i].z}) out << ", " << inp_number(x, negligible);
    out << '\n';
  }
}

/// "1, 4, 7, 9": the number of an element and those of its nodes, from 1.
template <class Nodes>
void write_inp_element(TextWriter& out, std::size_t number, const Nodes& nodes) {
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

/// What a label is the name of.
enum HexNameKind { kHexSet, kHexCurve, kHexFace, kHexVolume };
constexpr const char* kHexKinds[] = {"set", "curve", "face", "volume"};

UniqueLabels make_hex_labels(const Mesh& mesh) {
  std::vector<UniqueLabels::Key> keys;
  const auto add = [&](const std::vector<Entity>& entities, HexNameKind kind) {
    for (const Entity& entity : entities)
      for (const std::string& name : entity.names) keys.emplace_back(kind, name);
  };
  add(mesh.volumes, kHexVolume);
  add(mesh.regions, kHexFace);
  add(mesh.curves, kHexCurve);
  for (const char* all : {kAllElements, kAllNodes}) keys.emplace_back(kHexSet, all);
  return UniqueLabels(keys, {plain_label, true, kLongestInpName});
}

class HexInpWriter {
 public:
  HexInpWriter(TextWriter& out, const Mesh& mesh, const std::string& element)
      : out_(out),
        mesh_(mesh),
        labels_(make_hex_labels(mesh)),
        element_(element.empty() ? inp_hexahedra()[0] : element) {
    if (element_.find("20") == std::string::npos) return;
    for (const auto& hexahedron : mesh.hexahedra)
      for (const auto& [a, b] : edges_of(hexahedron)) edges_.push_back(std::minmax({a, b}));
    sort_unique(edges_);
  }

  void write() {
    write_inp_head(out_, "Mesh of hexahedra", mesh_.unit, labels_, kHexKinds);
    std::vector<Vec3> points = mesh_.points;
    for (const auto& [a, b] : edges_) points.push_back(0.5 * (mesh_.points[a] + mesh_.points[b]));
    write_inp_nodes(out_, points, labels_.of({kHexSet, kAllNodes}), [](std::size_t) { return true; });
    out_ << "*ELEMENT, TYPE=" << element_ << ", ELSET=" << labels_.of({kHexSet, kAllElements}) << '\n';
    for (std::size_t i = 0; i < mesh_.hexahedra.size(); ++i)
      write_inp_element(out_, i + 1, nodes_of(mesh_.hexahedra[i]));
    collect();
    write_inp_sets(out_, "ELSET", element_sets_);
    write_inp_sets(out_, "NSET", node_sets_);
    for (const auto& [label, sides] : sides_of_) {
      out_ << "*SURFACE, NAME=" << label << ", TYPE=ELEMENT\n";
      for (const int side : sides) out_ << side_set(label, side) << ", S" << side << '\n';
    }
  }

 private:
  static std::string side_set(const std::string& label, int side) {
    return "_" + label + "_S" + std::to_string(side);
  }

  /// In the order of their nodes in C3D20; of faces and curves in any.
  template <std::size_t N>
  static std::vector<std::pair<int, int>> edges_of(const std::array<int, N>& v) {
    std::vector<std::pair<int, int>> edges;
    if (N == 2) edges.emplace_back(v[0], v[1]);
    for (std::size_t side = 0; side + 4 <= N; side += 4)
      for (std::size_t k = 0; k < 4; ++k) edges.emplace_back(v[side + k], v[side + (k + 1) % 4]);
    for (std::size_t k = 4; k < N; ++k) edges.emplace_back(v[k - 4], v[k]);
    return edges;
  }

  /// Corners, and the middles of edges where there are any.
  template <std::size_t N>
  std::vector<int> nodes_of(const std::array<int, N>& corners) const {
    std::vector<int> nodes(corners.begin(), corners.end());
    if (edges_.empty()) return nodes;
    for (const auto& [a, b] : edges_of(corners)) {
      const auto at = std::ranges::lower_bound(edges_, std::pair(std::minmax({a, b})));
      nodes.push_back(static_cast<int>(mesh_.points.size()) + static_cast<int>(at - edges_.begin()));
    }
    return nodes;
  }

  template <std::size_t N>
  void collect_nodes(const std::vector<std::array<int, N>>& elements, const std::vector<int>& entity_of,
                     const std::vector<Entity>& entities, HexNameKind kind) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (const std::string& name : entities[entity_of[i]].names) {
        std::vector<int>& nodes = node_sets_[labels_.of({kind, name})];
        for (const int v : nodes_of(elements[i])) nodes.push_back(v + 1);
      }
  }

  void collect() {
    collect_nodes(mesh_.hexahedra, mesh_.hex_volume, mesh_.volumes, kHexVolume);
    collect_nodes(mesh_.quads, mesh_.quad_region, mesh_.regions, kHexFace);
    collect_nodes(mesh_.lines, mesh_.line_curve, mesh_.curves, kHexCurve);
    for (std::size_t i = 0; i < mesh_.hexahedra.size(); ++i)
      for (const std::string& name : mesh_.volumes[mesh_.hex_volume[i]].names)
        element_sets_[labels_.of({kHexVolume, name})].push_back(static_cast<int>(i) + 1);
    const std::vector<HexSide> sides = sorted_hex_sides(mesh_);
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
      const auto at = sides_at_quad(mesh_, sides, static_cast<int>(i));
      if (at.size() != 1) continue;
      for (const std::string& name : mesh_.regions[mesh_.quad_region[i]].names) {
        const std::string label = labels_.of({kHexFace, name});
        element_sets_[side_set(label, at[0].side)].push_back(at[0].hexahedron + 1);
        sides_of_[label].insert(at[0].side);
      }
    }
  }

  TextWriter& out_;
  const Mesh& mesh_;
  const UniqueLabels labels_;
  const std::string element_;
  std::vector<std::pair<int, int>> edges_;  ///< with a node in the middle; sorted
  Sets element_sets_, node_sets_;
  std::map<std::string, std::set<int>> sides_of_;
};

/// Every name of volumes is an ELSET and an NSET, of faces an NSET and, on the boundary, a SURFACE, of
/// curves an NSET.
void write_hex_inp(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  write_text_file(path, [&](TextWriter& out) { HexInpWriter(out, mesh, options.element).write(); });
}

/// What a label is the name of.
enum Kind { kPointTag, kCurveTag, kRegionTag, kPointName, kCurveName, kRegionName, kSet };
constexpr const char* kInpKinds[] = {"", "", "", "point", "curve", "region", "set"};

std::vector<UniqueLabels::Key> keys_of(const std::vector<Entity>& entities, int dim) {
  std::vector<UniqueLabels::Key> keys;
  for (const Entity& entity : entities) {
    keys.emplace_back(kPointTag + dim, tag_label(dim, entity.tag));
    for (const std::string& name : entity.names) keys.emplace_back(kPointName + dim, name);
  }
  return keys;
}

/// Both node sets of a pair of curves or of faces: images, and what they are images of.
std::array<std::string, 2> pair_names(const char* kind, size_t pair) {
  const std::string name = kind + std::to_string(pair + 1);
  return {name, name + "_MASTER"};
}
constexpr const char *kCurvePair = "PERIODIC_", *kFacePair = "PERIODIC_FACE_";

UniqueLabels make_labels(const Mesh& mesh) {
  std::vector<UniqueLabels::Key> keys = keys_of(mesh.curves, 1), of_regions = keys_of(mesh.regions, 2);
  keys.insert(keys.end(), of_regions.begin(), of_regions.end());
  for (const NamedPoint& named : mesh.named_points)
    for (auto& key : keys_of({named.entity}, 0)) keys.push_back(std::move(key));
  // Names that are tags keep them.
  std::ranges::stable_sort(
      keys, [](const auto& a, const auto& b) { return a.first <= kRegionTag && b.first > kRegionTag; });
  for (const auto& [kind, count] :
       {std::pair{kCurvePair, mesh.periodic.size()}, std::pair{kFacePair, mesh.periodic_faces.size()}})
    for (size_t i = 0; i < count; ++i)
      for (const std::string& name : pair_names(kind, i)) keys.emplace_back(kSet, name);
  for (const char* all : {kAllElements, kAllNodes}) keys.emplace_back(kSet, all);
  return UniqueLabels(keys, {plain_label, true, kLongestInpName});
}

class InpWriter {
 public:
  /// Plane elements that look down would be inverted.
  InpWriter(TextWriter& out, const Mesh& mesh, bool has_shells)
      : out_(out), mesh_(mesh), labels_(make_labels(mesh)), planar_(!has_shells && is_planar(mesh)) {}

  void write() {
    write_inp_head(out_, "Quad mesh", mesh_.unit, labels_, kInpKinds);
    write_nodes();
    int n = 0;
    write_elements(
        planar_ ? "CPS3" : "S3", mesh_.triangles.size(),
        n, [&](size_t i) -> const auto& { return mesh_.triangles[i]; });
    if (mesh_.order == 1)
      write_elements(
          planar_ ? "CPS4" : "S4", mesh_.quads.size(),
          n, [&](size_t i) -> const auto& { return mesh_.quads[i]; });
    else
      write_elements(planar_ ? "CPS8" : "S8R", mesh_.quads.size(), n,
                     [&](size_t i) { return eight_nodes(i); });
    collect_regions();
    collect_curves();
    for (const NamedPoint& named : mesh_.named_points)
      for (const std::string& label : labels_of(named.entity, 0)) add(node_sets_, label, {named.point + 1});
    for (auto* sets : {&element_sets_, &sides_}) write_inp_sets(out_, "ELSET", *sets);
    collect_pairs(kCurvePair, mesh_.periodic);
    collect_pairs(kFacePair, mesh_.periodic_faces);
    write_inp_sets(out_, "NSET", node_sets_);
    write_pairs(kCurvePair, mesh_.periodic);
    write_pairs(kFacePair, mesh_.periodic_faces);
    write_surfaces();
  }

 private:
  void write_nodes() {
    std::vector<char> inside(mesh_.points.size(), 0);
    for (size_t q = 0; q < mesh_.quads.size() && mesh_.order == 2; ++q)
      inside[nodes_of_quad(mesh_, q)[4]] = 1;
    write_inp_nodes(out_, mesh_.points, labels_.of({kSet, kAllNodes}), [&](size_t i) { return !inside[i]; });
  }

  template <class NodesOf>
  void write_elements(const char* type, size_t count, int& n, const NodesOf& nodes_of) {
    if (count == 0) return;
    out_ << "*ELEMENT, TYPE=" << type << ", ELSET=" << labels_.of({kSet, kAllElements}) << '\n';
    for (size_t i = 0; i < count; ++i) write_inp_element(out_, static_cast<size_t>(++n), nodes_of(i));
  }

  /// Corners and middles of sides; the node inside has no place in elements of Abaqus.
  std::vector<int> eight_nodes(size_t quad) const {
    std::vector<int> nodes = nodes_of_quad(mesh_, quad, gmsh_places(2));
    nodes.pop_back();
    return nodes;
  }

  std::vector<std::string> labels_of(const Entity& entity, int dim) const {
    std::vector<std::string> all;
    for (const auto& key : keys_of({entity}, dim)) all.push_back(labels_.of(key));
    return all;
  }

  static void add(Sets& sets, const std::string& label, const std::vector<int>& numbers) {
    std::vector<int>& all = sets[label];
    all.insert(all.end(), numbers.begin(), numbers.end());
  }

  void collect_regions() {
    std::vector<std::vector<int>> elements(mesh_.regions.size()), nodes(mesh_.regions.size());
    int n = 0;
    const auto collect = [&](const auto& all, const std::vector<int>& region_of) {
      for (size_t i = 0; i < all.size(); ++i) {
        elements[region_of[i]].push_back(++n);
        for (const int v : all[i]) nodes[region_of[i]].push_back(v + 1);
      }
    };
    collect(mesh_.triangles, mesh_.triangle_region);
    collect(mesh_.quads, mesh_.quad_region);
    for (size_t q = 0; q < mesh_.quads.size() && mesh_.order == 2; ++q)
      for (const int v : eight_nodes(q)) nodes[mesh_.quad_region[q]].push_back(v + 1);
    for (size_t r = 0; r < mesh_.regions.size(); ++r) {
      if (elements[r].empty()) continue;
      for (const std::string& label : labels_of(mesh_.regions[r], 2)) {
        add(element_sets_, label, elements[r]);
        add(node_sets_, label, nodes[r]);
      }
    }
  }

  /// Nodes of curves; of lines on the boundary the element's side, too.
  void collect_curves() {
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh_);
    for (size_t i = 0; i < mesh_.lines.size(); ++i) {
      std::vector<int> nodes = nodes_of_line(mesh_, i);
      for (int& v : nodes) ++v;
      const auto at_line = sides_of_edge(sides, mesh_.lines[i][0], mesh_.lines[i][1]);
      for (const std::string& label : labels_of(mesh_.curves[mesh_.line_curve[i]], 1)) {
        add(node_sets_, label, nodes);
        if (at_line.size() != 1) continue;
        add(surface_nodes_, label, nodes);
        const std::string side = side_name(at_line[0]);
        add(sides_, "_" + label + "_" + side, {at_line[0].element + 1});
        sides_of_[label].insert(side);
      }
    }
  }

  /// The k-th side lies between the k-th node and the next.
  std::string side_name(const HalfEdge& side) const {
    const auto number_in = [&](const auto& element) {
      const int from = side.forward ? side.lo : side.hi;
      return static_cast<int>(std::find(element.begin(), element.end(), from) - element.begin()) + 1;
    };
    const int n = static_cast<int>(mesh_.triangles.size());
    return (planar_ ? "S" : "E") + std::to_string(side.element < n
                                                      ? number_in(mesh_.triangles[side.element])
                                                      : number_in(mesh_.quads[side.element - n]));
  }

  template <class Pair>
  void collect_pairs(const char* kind, const std::vector<Pair>& pairs) {
    for (size_t i = 0; i < pairs.size(); ++i)
      for (const auto& nodes : pairs[i].nodes)
        for (const int side : {0, 1})
          add(node_sets_, labels_.of({kSet, pair_names(kind, i)[side]}), {nodes[side] + 1});
  }

  /// Which node is the image of which: sets have no order in both programs (CalculiX knows no UNSORTED), and
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
    for (auto& [label, nodes] : surface_nodes_) {
      out_ << "*SURFACE, NAME=" << label << ", TYPE=" << (planar_ ? "ELEMENT" : "NODE") << '\n';
      if (!planar_) write_inp_numbers(out_, nodes, 1);
      for (const std::string& side : sides_of_[label])
        if (planar_) out_ << '_' << label << '_' << side << ", " << side << '\n';
    }
  }

  TextWriter& out_;
  const Mesh& mesh_;
  const UniqueLabels labels_;
  const bool planar_;
  Sets element_sets_, node_sets_, sides_, surface_nodes_;
  std::map<std::string, std::set<std::string>> sides_of_;
};

/// Writes Abaqus input that CalculiX takes, too: numbers of at most 20 characters, shells S4 and S3. Elements
/// are CPS4 and CPS3 if all z are equal, they turn left and the options do not say S4. All elements are in
/// "Eall", all nodes in "Nall". Every region is an ELSET and an NSET, every curve an NSET and a SURFACE. They
/// go by tag ("region_3", "curve_5") and by each name, in letters, digits and underscores; comments have the
/// table. A curve's surface has the sides of plane elements, and the nodes of shells. Sides of shells are
/// ELSETs for edge loads ("_curve_5_E2").
void write_inp(const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options) {
  require_numbers(path, "Abaqus", mesh, 999'999'999);
  write_text_file(path, [&](TextWriter& out) { InpWriter(out, mesh, options.element == kShell).write(); });
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
                return std::move(deck.mesh);
              },
          .write =
              [](const std::filesystem::path& path, const Mesh& mesh, const MshOptions& options, QuadNodes) {
                if (mesh.hexahedra.empty())
                  write_inp(path, mesh, options);
                else
                  write_hex_inp(path, mesh, options);
              },
          .most_order = 2,
          .has_hexahedra = true,
          .eight_nodes = EightNodes::kAlways,
          .names = kAllNames | kFurtherNames | kPeriodicPairs,
          .read_given = [](const std::filesystem::path& path,
                           ReadNotes* notes) { return given_mesh(read_inp_deck(path, true), notes); },
          .rewrite = rewrite_inp,
          .others = [](const std::filesystem::path& path) { return read_inp_deck(path, false).others; }};
}

}  // namespace delquad
