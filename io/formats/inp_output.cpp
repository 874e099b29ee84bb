#include "io/formats/inp_output.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "base/box.h"
#include "io/entity_names.h"
#include "io/mesh_groups.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

constexpr std::ptrdiff_t kLongestInpNumber = 20;
/// On one line of a set, which may have no more.
constexpr std::size_t kInpNumbersPerLine = 16;

/// In at most 20 characters: CalculiX cuts off what follows, perhaps within the exponent. "0" below
/// `negligible`.
std::string inp_number(double x, double negligible) {
  if (std::abs(x) < negligible) return "0";
  char digits[32];
  char* end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  for (int n = 17; end - digits > kLongestInpNumber; --n)
    end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr;
  return {digits, end};
}

/// What a label is the name of.
enum HexNameKind { kHexCurve = 1, kHexFace, kHexVolume };

std::string hex_key_text(const UniqueLabels::Key& key) {
  constexpr std::array kKinds = {"curve", "face", "volume"};
  return std::string(kKinds.at(static_cast<std::size_t>(key.first) - 1)) + " \"" + one_line(key.second) + '"';
}

UniqueLabels make_hex_labels(const HexMesh& mesh) {
  std::vector<UniqueLabels::Key> keys;
  const auto add = [&](const std::vector<Entity>& entities, HexNameKind kind) {
    for (const Entity& entity : entities)
      for (const std::string& name : entity.names) keys.emplace_back(kind, name);
  };
  add(mesh.volumes, kHexVolume);
  add(mesh.faces, kHexFace);
  add(mesh.curves, kHexCurve);
  return UniqueLabels(keys, {plain_label, true, kLongestInpName});
}

/// A side of a hexahedron by its four nodes in order.
struct HexSide {
  std::array<int, 4> nodes;
  int hexahedron, side;
};

std::vector<HexSide> sorted_hex_sides(const HexMesh& mesh) {
  // S1 to S6 of C3D8.
  constexpr int kSides[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  std::vector<HexSide> sides;
  sides.reserve(6 * mesh.hexahedra.size());
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h)
    for (int s = 0; s < 6; ++s) {
      HexSide side{{}, static_cast<int>(h), s + 1};
      for (int k = 0; k < 4; ++k) side.nodes[k] = mesh.hexahedra[h][kSides[s][k]];
      std::sort(side.nodes.begin(), side.nodes.end());
      sides.push_back(side);
    }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const HexSide& a, const HexSide& b) { return a.nodes < b.nodes; });
  return sides;
}

class HexInpWriter {
 public:
  HexInpWriter(TextWriter& out, const HexMesh& mesh)
      : out_(out), mesh_(mesh), labels_(make_hex_labels(mesh)) {}

  void write() {
    out_ << "*HEADING\nMesh of hexahedra by Delquad\n";
    if (!mesh_.unit.empty()) out_ << "** lengths in " << mesh_.unit << '\n';
    for (const auto& [key, label] : labels_.renamed())
      out_ << "** " << hex_key_text(key) << " is " << label << '\n';
    const double negligible = kInpNegligible * diagonal(mesh_.points);
    out_ << "*NODE\n";
    for (std::size_t i = 0; i < mesh_.points.size(); ++i)
      write_inp_node(out_, i + 1, mesh_.points[i], negligible);
    out_ << "*ELEMENT, TYPE=C3D8\n";
    for (std::size_t i = 0; i < mesh_.hexahedra.size(); ++i)
      write_inp_element(out_, i + 1, mesh_.hexahedra[i]);
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

  template <std::size_t N>
  void collect_nodes(const std::vector<std::array<int, N>>& elements, const std::vector<int>& entity_of,
                     const std::vector<Entity>& entities, HexNameKind kind) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (const std::string& name : entities[entity_of[i]].names) {
        std::vector<int>& nodes = node_sets_[labels_.of({kind, name})];
        for (const int v : elements[i]) nodes.push_back(v + 1);
      }
  }

  void collect() {
    collect_nodes(mesh_.hexahedra, mesh_.hex_volume, mesh_.volumes, kHexVolume);
    collect_nodes(mesh_.quads, mesh_.quad_face, mesh_.faces, kHexFace);
    collect_nodes(mesh_.lines, mesh_.line_curve, mesh_.curves, kHexCurve);
    for (std::size_t i = 0; i < mesh_.hexahedra.size(); ++i)
      for (const std::string& name : mesh_.volumes[mesh_.hex_volume[i]].names)
        element_sets_[labels_.of({kHexVolume, name})].push_back(static_cast<int>(i) + 1);
    const std::vector<HexSide> sides = sorted_hex_sides(mesh_);
    for (std::size_t i = 0; i < mesh_.quads.size(); ++i) {
      std::array<int, 4> nodes = mesh_.quads[i];
      std::sort(nodes.begin(), nodes.end());
      const auto at = std::ranges::equal_range(sides, nodes, {}, &HexSide::nodes);
      if (at.size() != 1) continue;
      for (const std::string& name : mesh_.faces[mesh_.quad_face[i]].names) {
        const std::string label = labels_.of({kHexFace, name});
        element_sets_[side_set(label, at[0].side)].push_back(at[0].hexahedron + 1);
        sides_of_[label].insert(at[0].side);
      }
    }
  }

  TextWriter& out_;
  const HexMesh& mesh_;
  const UniqueLabels labels_;
  InpSets element_sets_, node_sets_;
  std::map<std::string, std::set<int>> sides_of_;
};

}  // namespace

void write_inp_node(TextWriter& out, std::size_t number, const Vec3& p, double negligible) {
  out << number;
  for (const double x : {p.x, p.y, p.z}) out << ", " << inp_number(x, negligible);
  out << '\n';
}

void write_inp_sets(TextWriter& out, const char* keyword, InpSets& sets) {
  for (auto& [label, numbers] : sets) {
    out << '*' << keyword << ", " << keyword << '=' << label << '\n';
    write_inp_numbers(out, numbers, kInpNumbersPerLine);
  }
}

void write_inp_numbers(TextWriter& out, std::vector<int>& numbers, std::size_t per_line) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size() || (i + 1) % per_line == 0;
    out << numbers[i] << (last ? "\n" : ", ");
  }
}

void write_hex_inp(const std::filesystem::path& path, const HexMesh& mesh) {
  write_text_file(path, [&](TextWriter& out) { HexInpWriter(out, mesh).write(); });
}

}  // namespace delquad
