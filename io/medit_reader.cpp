#include <fmt/format.h>

#include <climits>
#include <map>

#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "mesh/drop_unused_points.h"

namespace delquad {

namespace {

/// Twice as much is still a tag.
constexpr long long kMostReference = 999'999'999;

class MeditReader {
 public:
  explicit MeditReader(const std::filesystem::path& path) : in_(path) { refuse_other_kinds(in_, "Medit"); }

  Mesh read() {
    if (word("MeshVersionFormatted") != "MeshVersionFormatted")
      in_.fail("not a Medit file: expected MeshVersionFormatted");
    in_.integer("the version", 1, 4);
    while (true) {
      skip_comments();
      if (in_.at_end()) break;
      const std::string keyword = word("a keyword");
      if (keyword == "End") break;
      section(keyword);
    }
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty())
      in_.fail("the file holds no edges, triangles or quadrilaterals");
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void section(const std::string& keyword) {
    if (keyword == "Dimension") {
      skip_comments();
      dimension_ = in_.integer("the dimension", 2, 3);
    } else if (keyword == "Vertices") {
      for (long long n = count(); n > 0; --n) vertex();
    } else if (keyword == "Edges") {
      elements(mesh_.lines, mesh_.line_curve, 1);
    } else if (keyword == "Triangles") {
      elements(mesh_.triangles, mesh_.triangle_region, 2);
    } else if (keyword == "Quadrilaterals") {
      elements(mesh_.quads, mesh_.quad_region, 2);
    } else if (keyword == "Tetrahedra" || keyword == "Hexahedra") {
      in_.fail(fmt::format("{}: expected a mesh of lines, triangles and quadrilaterals", keyword));
    } else {
      skip_section();
    }
  }

  /// Numbers up to the next keyword.
  void skip_section() {
    while (!in_.at_end() && !next_is_letter()) {
      if (in_.next_is('#'))
        take_name();
      else
        in_.token("a number");
    }
  }

  bool next_is_letter() {
    for (char c = 'A'; c <= 'Z'; ++c)
      if (in_.next_is(c)) return true;
    return false;
  }

  /// Comments may be names: "# curve 3: north".
  void skip_comments() {
    while (in_.next_is('#')) take_name();
  }

  void take_name() {
    const std::string line(in_.rest_of_line());
    for (const auto& [kind, dim] : {std::pair{"# curve ", 1}, std::pair{"# region ", 2}}) {
      const size_t colon = line.find(": ");
      if (!line.starts_with(kind) || colon == std::string::npos) continue;
      const size_t first = std::string_view(kind).size();
      std::string name = line.substr(colon + 2);
      if (name.ends_with('\r')) name.pop_back();
      names_[{dim, line.substr(first, colon - first)}].push_back(std::move(name));
    }
  }

  std::string word(std::string_view what) {
    skip_comments();
    return std::string(in_.token(what));
  }

  long long count() {
    skip_comments();
    const long long n = in_.integer("a count", 0, INT_MAX);
    if (n > static_cast<long long>(in_.bytes_left()))
      in_.fail(fmt::format("{} items do not fit in the {} bytes that follow", n, in_.bytes_left()));
    return n;
  }

  void vertex() {
    skip_comments();
    const double x = in_.real("a coordinate"), y = in_.real("a coordinate");
    const double z = dimension_ == 3 ? in_.real("a coordinate") : 0;
    reference();
    mesh_.points.push_back({x, y, z});
  }

  long long reference() { return in_.integer("a reference", -kMostReference, kMostReference); }

  template <size_t N>
  void elements(std::vector<std::array<int, N>>& all, std::vector<int>& entity_of, int dim) {
    for (long long n = count(); n > 0; --n) {
      skip_comments();
      std::array<int, N> element;
      for (int& v : element)
        v = static_cast<int>(in_.integer("a vertex", 1, static_cast<long long>(mesh_.points.size()))) - 1;
      all.push_back(element);
      entity_of.push_back(entity(dim, reference()));
    }
  }

  /// References are tags where they are positive; others stand behind those.
  int entity(int dim, long long reference) {
    std::vector<Entity>& entities = dim == 1 ? mesh_.curves : mesh_.regions;
    const auto [it, is_new] = index_.emplace(std::pair{dim, reference}, static_cast<int>(entities.size()));
    if (is_new) {
      const long long tag = reference > 0 ? reference : kMostReference + 1 - reference;
      entities.push_back({static_cast<int>(tag), names_[{dim, std::to_string(reference)}]});
    }
    return it->second;
  }

  TextScanner in_;
  Mesh mesh_;
  long long dimension_ = 3;
  std::map<std::pair<int, std::string>, std::vector<std::string>> names_;
  std::map<std::pair<int, long long>, int> index_;
};

}  // namespace

Mesh read_medit(const std::filesystem::path& path) { return MeditReader(path).read(); }

}  // namespace delquad
