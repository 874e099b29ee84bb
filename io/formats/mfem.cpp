// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <climits>
#include <cmath>
#include <map>
#include <optional>

#include "base/text.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/element_nodes.h"
#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/formats/readers.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

constexpr int kMfemSegment = 1, kMfemTriangle = 2, kMfemSquare = 3;

struct MfemElement {
  long long attribute;
  int geometry;
  std::vector<int> v;  ///< vertices
  int line;            ///< of the file
};

/// How the nodes of curved elements are given.
struct MfemSpace {
  int order = 0;
  bool is_shared = false;   ///< H1: elements share nodes; L2: each has its own
  bool is_uniform = false;  ///< or at the points of Gauss and Lobatto
};

/// Returns the space of a collection's name, such as "H1_2D_P3"; nothing for others.
std::optional<MfemSpace> mfem_space(std::string_view name) {
  if (name == "Linear") return MfemSpace{1, true, false};
  if (name == "Quadratic") return MfemSpace{2, true, false};
  for (const auto& [prefix, is_shared, is_uniform] :
       {std::tuple{"H1_2D_P", true, false}, {"L2_T1_2D_P", false, false}, {"L2_T4_2D_P", false, true}}) {
    if (!name.starts_with(prefix)) continue;
    const std::string_view order = name.substr(std::string_view(prefix).size());
    if (order.size() == 1 && order[0] >= '1' && order[0] <= '0' + kMostOrder)
      return MfemSpace{order[0] - '0', is_shared, is_uniform};
  }
  return std::nullopt;
}

/// The points of Gauss and Lobatto in [0, 1].
std::vector<double> lobatto_points(int order) {
  const double third = 1 / std::sqrt(5.0), fourth = std::sqrt(3.0 / 7);
  if (order == 3) return {0, (1 - third) / 2, (1 + third) / 2, 1};
  if (order == 4) return {0, (1 - fourth) / 2, 0.5, (1 + fourth) / 2, 1};
  return order == 2 ? std::vector<double>{0, 0.5, 1} : std::vector<double>{0, 1};
}

/// Values of the same polynomials at equal distances; both in rows.
std::vector<Vec3> at_equal_distances(const std::vector<Vec3>& values, int order) {
  const std::vector<double> points = lobatto_points(order);
  const int row = order + 1;
  const auto weight = [&](int i, double t) {
    double w = 1;
    for (int k = 0; k < row; ++k)
      if (k != i) w *= (t - points[k]) / (points[i] - points[k]);
    return w;
  };
  std::vector<Vec3> result(values.size());
  for (int place = 0; place < row * row; ++place)
    for (int k = 0; k < row * row; ++k)
      result[place] = result[place] + weight(k % row, static_cast<double>(place % row) / order) *
                                          weight(k / row, static_cast<double>(place / row) / order) *
                                          values[k];
  return result;
}

class MfemReader {
 public:
  explicit MfemReader(const std::filesystem::path& path) : in_(path) { refuse_other_kinds(in_, "MFEM"); }

  Mesh read() {
    const std::string_view title = in_.rest_of_line();
    if (!title.starts_with("MFEM mesh v1.0") && !title.starts_with("MFEM mesh v1.2"))
      in_.fail("expected MFEM mesh v1.0");
    while (true) {
      skip_comments();
      if (in_.at_end()) break;
      const std::string keyword(in_.token("a section"));
      if (keyword == "mesh_end") break;
      section(keyword);
    }
    if (elements_.empty() && boundary_.empty()) in_.fail("the file holds no elements");
    check_vertices();
    if (space_.order == 0)
      make_straight();
    else
      make_curved();
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  void skip_comments() {
    while (in_.next_is('#')) {
      const std::string_view line = in_.rest_of_line();
      if (!entities_.take_name(line, "# attribute ", ": ", 2))
        entities_.take_name(line, "# boundary attribute ", ": ", 1);
      if (const std::string unit = unit_in_comment(line, "#"); !unit.empty()) mesh_.unit = unit;
    }
  }

  long long integer(const char* what, long long low, long long high) {
    skip_comments();
    return in_.integer(what, low, high);
  }

  long long count(const char* what) {
    skip_comments();
    return in_.count(what);
  }

  void section(const std::string& keyword) {
    if (keyword == "dimension") {
      if (integer("the dimension", 1, 3) != 2) in_.fail("expected dimension 2: triangles and quads");
    } else if (keyword == "elements") {
      for (long long n = count("the number of elements"); n > 0; --n) element(elements_);
    } else if (keyword == "boundary") {
      for (long long n = count("the number of elements on the boundary"); n > 0; --n) element(boundary_);
    } else if (keyword == "vertices") {
      vertices();
    } else if (keyword == "nodes") {
      nodes();
    } else {
      in_.fail("the section {}: expected dimension, elements, boundary, vertices or nodes",
               TextScanner::printable(keyword));
    }
  }

  void element(std::vector<MfemElement>& all) {
    constexpr long long kLargestNumber = NumberedEntities::kMostNumber;
    MfemElement e{integer("an attribute", -kLargestNumber, kLargestNumber), 0, {}, 0};
    e.geometry = static_cast<int>(integer("a type of geometry", 0, 7));
    const bool is_line = &all == &boundary_;
    if (is_line ? e.geometry != kMfemSegment : e.geometry != kMfemTriangle && e.geometry != kMfemSquare)
      in_.fail("geometry {}: expected {}", e.geometry,
               is_line ? "segments (1) on the boundary" : "triangles (2) or squares (3)");
    e.line = in_.line();
    for (int k = 0; k <= e.geometry; ++k)  // a segment has two, and so on
      e.v.push_back(static_cast<int>(integer("a vertex", 0, INT_MAX)));
    all.push_back(std::move(e));
  }

  double real(const char* what) {
    skip_comments();
    return in_.real(what);
  }

  void vertices() {
    n_vertices_ = count("the number of vertices");
    skip_comments();
    if (in_.at_end() || in_.next_is('n') || n_vertices_ == 0) return;  // they are nodes
    const long long dim = integer("the number of coordinates", 2, 3);
    for (long long i = 0; i < n_vertices_; ++i) {
      const double x = real("a coordinate"), y = real("a coordinate"),
                   z = dim == 3 ? real("a coordinate") : 0;
      mesh_.points.push_back({x, y, z});
    }
  }

  /// Returns the text behind a title such as "VDim:".
  std::string_view entry(const char* title) {
    skip_comments();
    if (in_.token(title) != title) in_.fail("expected {}", title);
    return in_.token(title);
  }

  void nodes() {
    skip_comments();
    if (in_.token("FiniteElementSpace") != "FiniteElementSpace") in_.fail("expected FiniteElementSpace");
    const std::string_view name = entry("FiniteElementCollection:");
    const auto space = mfem_space(name);
    if (!space)
      in_.fail("nodes of {}: expected H1_2D_P1, L2_T1_2D_P1 or L2_T4_2D_P1, up to P{}, or Quadratic",
               TextScanner::printable(name), kMostOrder);
    space_ = *space;
    const std::string_view dim = entry("VDim:");
    if (dim != "2" && dim != "3") in_.fail("VDim: expected 2 or 3");
    dim_ = dim == "2" ? 2 : 3;
    const std::string_view ordering = entry("Ordering:");
    if (ordering != "0" && ordering != "1") in_.fail("Ordering: expected 0 or 1");
    by_nodes_ = ordering == "0";
    skip_comments();
    while (!in_.at_end() && !in_.next_is('m')) {
      values_.push_back(real("a coordinate of a node"));
      skip_comments();
    }
  }

  void check_vertices() const {
    for (const auto* all : {&elements_, &boundary_})
      for (const MfemElement& e : *all)
        for (const int v : e.v)
          if (v >= n_vertices_)
            in_.fail_at(e.line, "there is no vertex {}: there are {}, counted from 0", v, n_vertices_);
  }

  void make_straight() {
    if (static_cast<long long>(mesh_.points.size()) != n_vertices_)
      in_.fail("vertices have no coordinates, and there are no nodes");
    for (const auto* all : {&elements_, &boundary_})  // a segment has two corners, and so on
      for (const MfemElement& e : *all)
        add_element(mesh_, e.geometry + 1, e.v,
                    entities_.index(e.geometry == kMfemSegment ? 1 : 2, e.attribute, mesh_));
  }

  /// The first node inside of the side from vertex a to b; -1: it is a new side. The others follow it, from
  /// the lower vertex to the higher one.
  int& first_on_side(int a, int b) { return sides_.emplace(std::minmax(a, b), -1).first->second; }

  /// Numbers of the nodes of an element of a shared space, in rows.
  std::vector<int> shared_nodes(const MfemElement& e, int& next_inside) {
    const int p = space_.order, row = p + 1;
    std::vector<int> square(static_cast<size_t>(row) * row);
    const int corners[] = {0, p, p * row + p, p * row};
    for (int k = 0; k < 4; ++k) {
      const int a = e.v[k], b = e.v[(k + 1) % 4];
      square[corners[k]] = a;
      std::vector<int> places = side_places(p, k);
      if (a > b) std::ranges::reverse(places);
      int node = first_on_side(a, b);
      for (const int place : places) square[place] = node++;
    }
    for (const int place : inner_places(p)) square[place] = next_inside++;
    return square;
  }

  void make_curved() {
    mesh_.points.clear();
    const int p = mesh_.order = space_.order, row = p + 1;
    int n_nodes = static_cast<int>(n_vertices_);
    for (const MfemElement& e : elements_) {
      if (e.geometry != kMfemSquare) in_.fail_at(e.line, "nodes of triangles: expected quads alone");
      for (int k = 0; k < 4; ++k)
        if (int& first = first_on_side(e.v[k], e.v[(k + 1) % 4]); first < 0)
          first = n_nodes, n_nodes += p - 1;
    }
    const long long inside = static_cast<long long>(elements_.size()) * (p - 1) * (p - 1);
    const long long in_file =
        space_.is_shared ? n_nodes + inside : static_cast<long long>(elements_.size()) * row * row;
    if (static_cast<long long>(values_.size()) != in_file * dim_)
      in_.fail("{} numbers for {} nodes of {} coordinates: expected one for each coordinate", values_.size(),
               in_file, dim_);
    mesh_.points.resize(static_cast<size_t>(n_nodes + inside));
    is_placed_.assign(mesh_.points.size(), 0);
    int next = n_nodes;
    std::vector<int> places;
    for (int k = 0; k < row * row; ++k) places.push_back(k);
    for (size_t i = 0; i < elements_.size(); ++i) {
      const std::vector<int> square = shared_nodes(elements_[i], next);
      place_nodes(i, square, in_file);
      add_quad(mesh_, square, places, entities_.index(2, elements_[i].attribute, mesh_));
    }
    for (const MfemElement& e : boundary_) add_curved_line(e);
  }

  void place_nodes(size_t element, const std::vector<int>& square, long long n_nodes) {
    std::vector<Vec3> at;
    for (size_t k = 0; k < square.size(); ++k) {
      const size_t node = space_.is_shared ? static_cast<size_t>(square[k]) : element * square.size() + k;
      const auto value = [&](int axis) {
        const auto a = static_cast<size_t>(axis);
        return values_[by_nodes_ ? a * static_cast<size_t>(n_nodes) + node
                                 : node * static_cast<size_t>(dim_) + a];
      };
      at.push_back({value(0), value(1), dim_ == 3 ? value(2) : 0});
    }
    if (!space_.is_uniform && space_.order > 2) at = at_equal_distances(at, space_.order);
    constexpr double kRounding = 1e-9;  // of the element's size
    double size = 0;
    for (const Vec3& x : at) size = std::max(size, norm(x - at[0]));
    for (size_t k = 0; k < square.size(); ++k) {
      Vec3& point = mesh_.points[square[k]];
      if (is_placed_[square[k]] && !(norm(point - at[k]) <= kRounding * size))
        in_.fail_at(elements_[element].line,
                    "element {} (from 0) has a node at {}, another element has it at "
                    "{}: expected elements that hang together",
                    element, show_point(at[k]), show_point(point));
      if (!is_placed_[square[k]]) point = at[k];
      is_placed_[square[k]] = 1;
    }
  }

  void add_curved_line(const MfemElement& e) {
    const auto side = sides_.find(std::minmax(e.v[0], e.v[1]));
    if (side == sides_.end()) in_.fail_at(e.line, "a line on the boundary is no side of an element");
    std::vector<int> nodes{e.v[0], e.v[1]};
    for (int k = 0; k < space_.order - 1; ++k)
      nodes.push_back(side->second + (e.v[0] < e.v[1] ? k : space_.order - 2 - k));
    add_line(mesh_, nodes, entities_.index(1, e.attribute, mesh_));
  }

  TextScanner in_;
  Mesh mesh_;
  NumberedEntities entities_;
  std::vector<MfemElement> elements_, boundary_;
  long long n_vertices_ = 0;
  MfemSpace space_;
  int dim_ = 2;
  bool by_nodes_ = false;
  std::vector<double> values_;
  std::map<std::pair<int, int>, int> sides_;  ///< by vertices, the lower first
  std::vector<char> is_placed_;
};

/// Writes the places of vertices, or of the nodes of curved quads.
void write_places(TextWriter& out, const Mesh& mesh, const std::vector<int>& vertex, int n_vertices) {
  const int space = is_planar(mesh) ? 2 : 3;
  const auto write_place = [&](const Vec3& p) {
    out << p.x << ' ' << p.y;
    if (space == 3) out << ' ' << p.z;
    out << '\n';
  };
  out << "\nvertices\n" << n_vertices << '\n';
  if (mesh.order == 1) {
    out << space << '\n';
    for (std::size_t i = 0; i < vertex.size(); ++i)
      if (vertex[i] >= 0) write_place(mesh.points[i]);
  } else {
    // Closed uniform points (type 4), as ours; the space knows no common nodes, but the places are the
    // same.
    out << "\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T4_2D_P" << mesh.order
        << "\nVDim: " << space << "\nOrdering: 1\n\n";
    for (std::size_t q = 0; q < mesh.quads.size(); ++q)
      for (const int v : nodes_of_quad(mesh, q)) write_place(mesh.points[v]);
  }
}

/// MFEM's own format (1.0): attributes are the numbers of names, which comments tell.
void write_mfem(const std::filesystem::path& path, const Mesh& mesh) {
  const auto row = static_cast<std::size_t>(mesh.order) + 1;
  require_fits(path, "MFEM", mesh.order == 1 ? 0 : 3 * row * row * mesh.quads.size(), "coordinates of nodes",
               INT_MAX);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const CellSides sides(mesh);
  const std::vector<CellBlock> blocks = cell_blocks(mesh);
  const int dim = dimension_of(mesh);
  const std::vector<int> attribute = group_numbers(mesh, groups, dim);
  const std::vector<int> of_sides = group_numbers(mesh, groups, dim - 1);
  /// Calls f(cells, i) for each element of a dimension.
  const auto for_each = [&](int dimension, const auto& f) {
    for (const CellBlock& cells : blocks)
      for (std::size_t i = 0; i < cells.size() && cells.dim == dimension; ++i) f(cells, i);
  };
  const auto corners = [](const CellBlock& cells, std::size_t i) {
    std::vector<int> nodes = cells.nodes(i);
    nodes.resize(static_cast<std::size_t>(corners_of(cells.shape)));
    return nodes;
  };
  const auto is_outside = [&](const CellBlock& cells, std::size_t i) {
    return sides.at(static_cast<int>(cells.first + i)).size() == 1;
  };
  // Curved meshes list the nodes of each element; vertices are the corners alone.
  std::vector<int> vertex(mesh.points.size(), -1);
  int n_vertices = 0, n_boundary = 0;
  for_each(dim, [&](const CellBlock& cells, std::size_t i) {
    for (const int v : corners(cells, i)) vertex[v] = 0;
  });
  for (int& v : vertex)
    if (v == 0) v = n_vertices++;
  for_each(dim - 1,
           [&](const CellBlock& cells, std::size_t i) { n_boundary += is_outside(cells, i) ? 1 : 0; });
  constexpr std::array<int, kCellShapes> kGeometries = {0, kMfemSegment, kMfemTriangle, kMfemSquare, 5, 6, 7,
                                                        4};
  write_text_file(path, [&](TextWriter& out) {
    out << "MFEM mesh v1.0\n\n# " << (dim == 3 ? "volume" : "quad") << " mesh by Delquad\n";
    if (!mesh.unit.empty()) out << "# lengths in " << mesh.unit << '\n';
    for (const MeshGroup& group : groups)
      if (group.dim >= dim - 1)
        out << "# " << (group.dim < dim ? "boundary " : "") << "attribute " << group.number << ": "
            << one_line(group.name) << '\n';
    const auto write = [&](int number, const CellBlock& cells, std::size_t i) {
      out << number << ' ' << kGeometries[static_cast<std::size_t>(cells.shape)];
      for (const int v : corners(cells, i)) out << ' ' << vertex[v];
      out << '\n';
    };
    out << "\ndimension\n" << dim << "\n\nelements\n" << n_cells(mesh, dim) << '\n';
    for_each(dim,
             [&](const CellBlock& cells, std::size_t i) { write(attribute[cells.first + i], cells, i); });
    out << "\nboundary\n" << n_boundary << '\n';
    for_each(dim - 1, [&](const CellBlock& cells, std::size_t i) {
      if (is_outside(cells, i)) write(of_sides[cells.first + i], cells, i);
    });
    write_places(out, mesh, vertex, n_vertices);
  });
}

}  // namespace

Mesh read_mfem(const std::filesystem::path& path) { return MfemReader(path).read(); }

MeshFormat mfem_format() {
  return {.extensions = {".mfem"},
          .description = "MFEM 1.0",
          .read = read_by<read_mfem>,
          .write = write_by<write_mfem>,
          .most_order = kMostOrder,
          .has_cells = true,
          .names = kAllNames & ~kPointNames};
}

}  // namespace delquad
