#include <fmt/format.h>

#include <climits>
#include <unordered_map>

#include "geometry/mesh/drop_unused_points.h"
#include "io/formats/readers.h"
#include "io/mesh_io.h"
#include "io/numbered_entities.h"
#include "io/text_scanner.h"

namespace delquad {

namespace {

class UcdReader {
 public:
  explicit UcdReader(const std::filesystem::path& path) : in_(path) { refuse_other_kinds(in_, "UCD"); }

  Mesh read() {
    skip_comments();
    const long long n_points = in_.count("the number of nodes"), n_cells = in_.count("the number of cells");
    long long n_values = 0;
    for (const char* what : {"nodes", "cells", "the model"})
      n_values += in_.integer(fmt::format("the number of values of {}", what), 0, INT_MAX);
    for (long long i = 0; i < n_points; ++i) node();
    for (long long i = 0; i < n_cells; ++i) cell();
    if (mesh_.lines.empty() && mesh_.triangles.empty() && mesh_.quads.empty())
      in_.fail("the file holds no lines, triangles or quads");
    // Values follow, where they are announced, which are no part of the mesh.
    skip_comments();
    if (n_values == 0 && !in_.at_end())
      in_.fail(fmt::format(
          "expected the end of the file after {} nodes and {} cells, as the header says, found {}", n_points,
          n_cells, TextScanner::printable(in_.token("the end"))));
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void skip_comments() {
    while (in_.next_is('#')) {
      const std::string_view line = in_.rest_of_line();
      if (!entities_.take_name(line, "# material ", ": ", 2))
        entities_.take_name(line, "# material ", " of lines: ", 1);
      if (const std::string unit = unit_in_comment(line, "#"); !unit.empty()) mesh_.unit = unit;
    }
  }

  void node() {
    const long long number = in_.integer("a node's number", 0, LLONG_MAX);
    if (!node_of_.emplace(number, static_cast<int>(mesh_.points.size())).second)
      in_.fail(fmt::format("node {} is there twice", number));
    const double x = in_.real("a coordinate"), y = in_.real("a coordinate"), z = in_.real("a coordinate");
    mesh_.points.push_back({x, y, z});
  }

  template <size_t N>
  std::array<int, N> nodes() {
    std::array<int, N> v;
    for (int& i : v) {
      const long long number = in_.integer("a node's number", 0, LLONG_MAX);
      const auto found = node_of_.find(number);
      if (found == node_of_.end()) in_.fail(fmt::format("there is no node {}", number));
      i = found->second;
    }
    return v;
  }

  void cell() {
    constexpr long long kLargestNumber = NumberedEntities::kMostNumber;
    in_.integer("a cell's number", 0, LLONG_MAX);
    const long long material = in_.integer("a material", -kLargestNumber, kLargestNumber);
    const std::string type(in_.token("a type of cell"));
    const auto entity = [&](int dim) { return entities_.index(dim, material, mesh_); };
    if (type == "pt") {
      nodes<1>();
    } else if (type == "line") {
      mesh_.lines.push_back(nodes<2>());
      mesh_.line_curve.push_back(entity(1));
    } else if (type == "tri") {
      mesh_.triangles.push_back(nodes<3>());
      mesh_.triangle_region.push_back(entity(2));
    } else if (type == "quad") {
      mesh_.quads.push_back(nodes<4>());
      mesh_.quad_region.push_back(entity(2));
    } else {
      in_.fail(
          fmt::format("a cell of type {}: expected pt, line, tri or quad", TextScanner::printable(type)));
    }
  }

  TextScanner in_;
  Mesh mesh_;
  NumberedEntities entities_;
  std::unordered_map<long long, int> node_of_;
};

}  // namespace

Mesh read_ucd(const std::filesystem::path& path) { return UcdReader(path).read(); }

}  // namespace delquad
