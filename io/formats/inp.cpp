#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/entity_names.h"
#include "io/formats/inp_output.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

/// What a label is the name of.
enum Kind { kPointTag, kCurveTag, kRegionTag, kPointName, kCurveName, kRegionName, kPairs };

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
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
    return a.first <= kRegionTag && b.first > kRegionTag;
  });
  for (const auto& [kind, count] :
       {std::pair{kCurvePair, mesh.periodic.size()}, std::pair{kFacePair, mesh.periodic_faces.size()}})
    for (size_t i = 0; i < count; ++i)
      for (const std::string& name : pair_names(kind, i)) keys.emplace_back(kPairs, name);
  return UniqueLabels(keys, {plain_label, true, kLongestInpName});
}

/// Members of a set by its label.
using Sets = std::map<std::string, std::vector<int>>;

class InpWriter {
 public:
  InpWriter(TextWriter& out, const Mesh& mesh) : out_(out), mesh_(mesh), labels_(make_labels(mesh)) {
    planar_ = is_planar(mesh);  // plane elements of a face that looks down would be inverted
  }

  void write() {
    out_ << "*HEADING\nQuad mesh by Delquad\n";
    if (!mesh_.unit.empty()) out_ << "** lengths in " << mesh_.unit << '\n';
    write_renamed();
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
  void write_renamed() {
    for (const auto& [key, label] : labels_.renamed())
      out_ << "** "
           << (key.first == kPointName   ? "point"
               : key.first == kCurveName ? "curve"
               : key.first == kPairs     ? "set"
                                         : "region")
           << " \"" << one_line(key.second) << "\" is " << label << '\n';
  }

  void write_nodes() {
    const double negligible = kInpNegligible * diagonal(mesh_);
    std::vector<char> inside(mesh_.points.size(), 0);
    for (size_t q = 0; q < mesh_.quads.size() && mesh_.order == 2; ++q)
      inside[nodes_of_quad(mesh_, q)[4]] = 1;
    out_ << "*NODE\n";
    for (size_t i = 0; i < mesh_.points.size(); ++i) {
      if (!inside[i]) write_inp_node(out_, i + 1, mesh_.points[i], negligible);
    }
  }

  template <class NodesOf>
  void write_elements(const char* type, size_t count, int& n, const NodesOf& nodes_of) {
    if (count == 0) return;
    out_ << "*ELEMENT, TYPE=" << type << '\n';
    for (size_t i = 0; i < count; ++i) {
      write_inp_element(out_, static_cast<size_t>(++n), nodes_of(i));
    }
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
          add(node_sets_, labels_.of({kPairs, pair_names(kind, i)[side]}), {nodes[side] + 1});
  }

  /// Which node is the image of which: sets have no order in both programs (CalculiX knows no UNSORTED), and
  /// equations of CalculiX take nodes one by one.
  template <class Pair>
  void write_pairs(const char* kind, const std::vector<Pair>& pairs) {
    for (size_t i = 0; i < pairs.size(); ++i)
      for (const auto& nodes : pairs[i].nodes)
        out_ << "** " << labels_.of({kPairs, pair_names(kind, i)[0]}) << ": " << nodes[0] + 1 << ", "
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
  bool planar_ = false;
  Sets element_sets_, node_sets_, sides_, surface_nodes_;
  std::map<std::string, std::set<std::string>> sides_of_;
};

/// Abaqus input, as CalculiX takes it, too: numbers of at most 20 characters, shells S4 and S3, or CPS4 and
/// CPS3 when all z are equal and elements turn left. Every region is an ELSET and an NSET, every curve an
/// NSET and a SURFACE, by its tag ("region_3", "curve_5") and by each of its names, as far as Abaqus takes
/// them (letters, digits, underscores); comments have the table. Of plane elements a curve's surface has the
/// sides, of shells the nodes, and the sides are ELSETs for edge loads ("_curve_5_E2").
void write_inp(const std::filesystem::path& path, const Mesh& mesh) {
  require_numbers(path, "Abaqus", mesh, 999'999'999);
  write_text_file(path, [&](TextWriter& out) { InpWriter(out, mesh).write(); });
}

}  // namespace

MeshFormat inp_format() {
  return {.extensions = {".inp"},
          .description = "Abaqus, CalculiX",
          .read = read_by<read_inp>,
          .write = write_by<write_inp>,
          .most_order = 2,
          .write_hexahedra = [](const std::filesystem::path& path, const HexMesh& mesh,
                                bool) { write_hex_inp(path, mesh); },
          .eight_nodes = EightNodes::kAlways};
}

}  // namespace delquad
