#include <algorithm>
#include <map>
#include <set>

#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

/// Numbers on one line of a set, which may have no more.
constexpr int kNumbersPerLine = 16;
/// The longest name that Abaqus takes.
constexpr size_t kLongestName = 80;

/// A label as Abaqus takes it: letters, digits and underscores, beginning with a letter; letters of other
/// alphabets become underscores. Labels that would be one, Abaqus being blind to case, get numbers.
class Labels {
 public:
  const std::string& of(const std::string& name) {
    const auto [it, is_new] = label_of_.try_emplace(name);
    if (is_new) it->second = unused(plain(name));
    return it->second;
  }

 private:
  static std::string plain(const std::string& name) {
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    std::string label = name.empty() || !is_letter(name[0]) ? "SET_" : "";
    for (const char c : name) label += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
    return label.substr(0, kLongestName - 10);
  }
  std::string unused(const std::string& label) {
    const auto upper = [](std::string text) {
      for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
      return text;
    };
    std::string candidate = label;
    for (int k = 2; !used_.insert(upper(candidate)).second; ++k) candidate = label + "_" + std::to_string(k);
    return candidate;
  }

  std::map<std::string, std::string> label_of_;
  std::set<std::string> used_;
};

void write_numbers(TextWriter& out, const std::vector<int>& numbers) {
  for (size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size() || (i + 1) % kNumbersPerLine == 0;
    out << numbers[i] << (last ? "\n" : ", ");
  }
}

/// Elements or nodes by the name of the group that holds them, ascending; an entity without a name is its own
/// group, called by its kind and tag.
using Groups = std::map<std::string, std::vector<int>>;

void add(Groups& groups, const Entity& entity, const char* kind, const std::vector<int>& numbers) {
  const auto add_to = [&](const std::string& name) {
    groups[name].insert(groups[name].end(), numbers.begin(), numbers.end());
  };
  for (const std::string& name : entity.names) add_to(name);
  if (entity.names.empty()) add_to(kind + std::to_string(entity.tag));
}

void write_sets(TextWriter& out, const char* keyword, Groups& groups) {
  Labels labels;
  for (auto& [name, numbers] : groups) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    out << '*' << keyword << ", " << keyword << '=' << labels.of(name) << '\n';
    write_numbers(out, numbers);
  }
}

template <size_t N>
void write_elements(TextWriter& out, const char* type, const std::vector<std::array<int, N>>& elements,
                    int& number) {
  if (elements.empty()) return;
  out << "*ELEMENT, TYPE=" << type << '\n';
  for (const auto& element : elements) {
    out << ++number;
    for (const int v : element) out << ", " << v + 1;
    out << '\n';
  }
}

template <size_t N>
void add_nodes(std::vector<std::vector<int>>& nodes, const std::vector<std::array<int, N>>& elements,
               const std::vector<int>& entity_of) {
  for (size_t i = 0; i < elements.size(); ++i)
    for (const int v : elements[i]) nodes[entity_of[i]].push_back(v + 1);
}

void write(TextWriter& out, const Mesh& mesh) {
  const bool planar = std::all_of(mesh.points.begin(), mesh.points.end(),
                                  [&](const Vec3& p) { return p.z == mesh.points[0].z; });
  out << "*HEADING\nQuad mesh by Delquad\n*NODE\n";
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    out << i + 1 << ", " << p.x << ", " << p.y << ", " << p.z << '\n';
  }
  int number = 0;
  write_elements(out, planar ? "CPS3" : "S3", mesh.triangles, number);
  write_elements(out, planar ? "CPS4" : "S4", mesh.quads, number);

  std::vector<std::vector<int>> elements_of(mesh.regions.size()), nodes_of(mesh.regions.size()),
      nodes_on(mesh.curves.size());
  number = 0;
  for (const int region : mesh.triangle_region) elements_of[region].push_back(++number);
  for (const int region : mesh.quad_region) elements_of[region].push_back(++number);
  add_nodes(nodes_of, mesh.triangles, mesh.triangle_region);
  add_nodes(nodes_of, mesh.quads, mesh.quad_region);
  add_nodes(nodes_on, mesh.lines, mesh.line_curve);
  Groups element_sets, node_sets;
  for (size_t r = 0; r < mesh.regions.size(); ++r) {
    if (elements_of[r].empty()) continue;
    add(element_sets, mesh.regions[r], "region ", elements_of[r]);
    add(node_sets, mesh.regions[r], "region ", nodes_of[r]);
  }
  for (size_t c = 0; c < mesh.curves.size(); ++c) {
    if (!nodes_on[c].empty()) add(node_sets, mesh.curves[c], "curve ", nodes_on[c]);
  }
  write_sets(out, "ELSET", element_sets);
  write_sets(out, "NSET", node_sets);
}

}  // namespace

void write_inp(const std::filesystem::path& path, const Mesh& mesh) {
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    write(out, mesh);
    out.flush();
  });
}

}  // namespace delquad
