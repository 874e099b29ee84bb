// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/nodal_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/check_mesh.h"
#include "io/cell_view.h"
#include "io/formats/msh.h"
#include "io/formats/msh_raw.h"
#include "io/formats/vtu.h"

namespace delquad {

namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double area(const Mesh& mesh, const std::array<int, 3>& v) {
  return norm(cross(mesh.points[v[1]] - mesh.points[v[0]], mesh.points[v[2]] - mesh.points[v[0]])) / 2;
}

/// The values of tags, in their order; NaN where there is none.
std::vector<double> in_order(const msh::View& view, const std::vector<long long>& tags) {
  std::unordered_map<long long, std::size_t> place;
  for (std::size_t i = 0; i < view.values.size(); ++i) place[view.values[i].first] = i;
  const auto further = static_cast<std::size_t>(view.n_components - 1);
  std::vector<double> result;
  for (const long long tag : tags) {
    const auto found = place.find(tag);
    result.push_back(found == place.end() ? kNoValue : view.values[found->second].second);
    for (std::size_t k = 0; k < further; ++k)
      result.push_back(found == place.end() ? kNoValue : view.further[found->second * further + k]);
  }
  return result;
}

MeshWithFields read_msh_fields(const std::filesystem::path& path, const FieldChoice& choice) {
  TextScanner scanner(path);
  refuse_other_kinds(scanner, "MSH");
  msh::Contents contents = msh::read_contents(scanner, true);
  const std::vector<msh::View> views = std::move(contents.views);
  std::vector<MeshField> all;
  for (const msh::View& view : views) all.push_back({view.name, view.is_of_nodes, view.n_components, {}});
  const std::vector<std::size_t> chosen = choice(all);
  msh::MeshTags tags;
  MeshWithFields result{msh::to_mesh(std::move(contents), scanner, &tags), {}};
  require_own_points(result.mesh, tags.points.size(), path);
  std::vector<long long> of_elements;
  for (std::size_t s = 0; s < kCellShapes; ++s)
    if (dimension_of(static_cast<CellShape>(s)) == dimension_of(result.mesh))
      of_elements.insert(of_elements.end(), tags.elements[s].begin(), tags.elements[s].end());
  for (const std::size_t i : chosen) {
    all[i].values = in_order(views[i], all[i].is_of_points ? tags.points : of_elements);
    result.fields.push_back(std::move(all[i]));
  }
  return result;
}

MeshWithFields read_chosen(const std::filesystem::path& path, const FieldChoice& choice) {
  MeshWithFields whole = (kind_of_file(path) == ".vtu" ? read_vtu_fields : read_msh_fields)(path, choice);
  const std::size_t n_points = whole.mesh.points.size();
  complete_faces(whole.mesh, nullptr);
  require_own_points(whole.mesh, n_points, path);
  return whole;
}

void check_number(TextScanner& in, std::size_t n_points) {
  const long long n = in.count("the number of values");
  if (n != static_cast<long long>(n_points))
    in.fail("values of {} points: expected {}, as its mesh has", n, n_points);
}

/// Goes to the values of a solution file of Medit and returns how many numbers there are for each of them.
std::size_t find_solution(TextScanner& in, std::size_t width, std::size_t n_points) {
  constexpr int kTensor = 3;
  long long dimension = 0;
  while (!in.at_end()) {
    const std::string keyword(in.token("a keyword"));
    if (keyword == "MeshVersionFormatted") in.integer("the version", 1, 4);
    if (keyword == "Dimension") dimension = in.integer("the dimension", 2, 3);
    if (keyword != "SolAtVertices") continue;
    check_number(in, n_points);
    const long long n_fields = in.integer("the number of solutions", 1, 100);
    const long long kind = in.integer("the type of a solution", 1, kTensor);
    if (n_fields != 1 || kind != (width == 1 ? 1 : kTensor))
      in.fail("{} solution(s), the first of type {}: expected one of type {}", n_fields, kind,
              width == 1 ? 1 : kTensor);
    return width == 1 ? 1 : dimension == 3 ? 6 : 3;
  }
  in.fail("no SolAtVertices");
}

/// The same of a metric of BAMG, which begins with them.
std::size_t find_bamg_metric(TextScanner& in, std::size_t width, std::size_t n_points) {
  check_number(in, n_points);
  const std::size_t wanted = width == 1 ? 1 : 3;
  const long long n = in.integer("how many numbers a point has", 1, 3);
  if (n != static_cast<long long>(wanted)) in.fail("{} numbers at each point: expected {}", n, wanted);
  return wanted;
}

/// A file of values alone, of the mesh with the same name. `width`: numbers at each point: 1, or 6 of a
/// tensor (m11, m12, m13, m22, m23, m33; m11, m12, m22 in the plane's files).
NodalValues read_beside_mesh(const std::filesystem::path& path, std::size_t width) {
  std::filesystem::path mesh_file = path;
  if (!std::filesystem::exists(mesh_file.replace_extension(".mesh")))
    refuse("{}: its mesh is missing: expected '{}'", path.string(), mesh_file.string());
  NodalValues result{read_mesh(mesh_file), {}};
  TextScanner in(path);
  const std::size_t n_points = result.mesh.points.size();
  const std::size_t given =
      (kind_of_file(path) == ".sol" ? find_solution : find_bamg_metric)(in, width, n_points);
  for (std::size_t i = 0; i < n_points; ++i) {
    std::array<double, 6> value{};
    for (std::size_t k = 0; k < given; ++k) value[k] = in.real("a value");
    if (given == 3) value = {value[0], value[1], 0, value[2], 0, 1};
    // Medit has m11, m12, m22, m13, m23 and m33.
    if (given == 6) std::swap(value[2], value[3]);
    result.values.insert(result.values.end(), value.begin(), value.begin() + static_cast<long>(width));
  }
  return result;
}

/// Lines' own points, which a field on faces says nothing of, go.
void require_values(NodalValues& field, const std::string& file) {
  const std::size_t width = field.values.size() / std::max<std::size_t>(1, field.mesh.points.size());
  std::vector<char> is_used(field.mesh.points.size(), 0);
  for (const auto& e : field.mesh.triangles)
    for (const int v : e) is_used[v] = 1;
  for (const auto& e : field.mesh.quads)
    for (const int v : e) is_used[v] = 1;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) {
      field.values[width * i] = 1;  // is never asked for
      constexpr double kUnit[] = {1, 0, 0, 1, 0, 1};
      if (width > 1) std::copy_n(kUnit, width, field.values.begin() + static_cast<long>(width * i));
    } else if (std::isnan(field.values[width * i])) {
      const Vec3& p = field.mesh.points[i];
      refuse("{}: the field has no value at {}: expected a value at each point of its mesh", file,
             show_point(p));
    }
  }
}

}  // namespace

std::size_t choose_field(const std::vector<MeshField>& fields, const std::string& name,
                         const std::string& file, const FieldForm& form) {
  std::set<std::string> names;
  for (const MeshField& field : fields)
    if (field.is_of_points || !form.of_points) names.insert(TextScanner::printable(field.name));
  if (fields.empty())
    refuse("{}: has no field: expected $NodeData or $ElementData, or in a VTU file point data or cell data",
           file);
  if (name.empty() && names.size() > 1)
    refuse("{}: has the fields {}: say which, as {}:NAME [which-field]", file, fmt::join(names, ", "),
           std::filesystem::path(file).filename().string());
  const MeshField* of_elements = nullptr;
  for (std::size_t i = fields.size(); i-- > 0;) {
    if (!name.empty() && fields[i].name != name) continue;
    if (form.of_points && !fields[i].is_of_points) {
      of_elements = &fields[i];
      continue;
    }
    if (std::ranges::find(form.n_components, fields[i].n_components) != form.n_components.end()) return i;
    refuse("{}: the field {} has {} components: expected {}", file, TextScanner::printable(fields[i].name),
           fields[i].n_components, fmt::join(form.n_components, ", "));
  }
  if (of_elements != nullptr)
    refuse("{}: the field {} is of elements: expected one of points [field-of-elements]", file,
           TextScanner::printable(of_elements->name));
  if (names.empty())
    refuse("{}: has no field of points: expected $NodeData, or point data in a VTU file", file);
  refuse("{}: has no field {}: expected {}", file, TextScanner::printable(name), fmt::join(names, ", "));
}

namespace {

/// Means, by area, of the values of the elements at each point, `width` side by side; NaN where there is no
/// element.
std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_elements,
                                    std::size_t width) {
  std::vector<double> sum(width * mesh.points.size(), 0), weight(mesh.points.size(), 0);
  const auto add = [&](const auto& element, double size, const double* values) {
    for (const int v : element) {
      for (std::size_t k = 0; k < width; ++k) sum[width * v + k] += size * values[k];
      weight[v] += size;
    }
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    add(mesh.triangles[i], area(mesh, mesh.triangles[i]), &of_elements[width * i]);
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) {
    const auto [a, b, c, d] = mesh.quads[i];
    add(mesh.quads[i], area(mesh, {a, b, c}) + area(mesh, {a, c, d}),
        &of_elements[width * (mesh.triangles.size() + i)]);
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] = weight[i / width] > 0 ? sum[i] / weight[i / width] : kNoValue;
  return sum;
}

/// Returns m11, m12, m13, m22, m23 and m33 of rows of 2 x 2 or 3 x 3 numbers, or of symmetric ones of VTK.
/// VTK has the diagonal first: xx, yy, xy, or xx, yy, zz, xy, yz, xz.
std::vector<double> as_tensors(const std::vector<double>& all, int n_components) {
  constexpr int kZero = -1, kOne = -2;
  static const std::map<int, std::array<int, 6>> places = {{3, {0, 2, kZero, 1, kZero, kOne}},
                                                           {4, {0, 1, kZero, 3, kZero, kOne}},
                                                           {6, {0, 3, 5, 1, 4, 2}},
                                                           {9, {0, 1, 2, 4, 5, 8}}};
  std::vector<double> tensors;
  for (std::size_t at = 0; at < all.size(); at += static_cast<std::size_t>(n_components))
    for (const int k : places.at(n_components))
      tensors.push_back(k == kZero ? 0 : k == kOne ? 1 : all[at + static_cast<std::size_t>(k)]);
  return tensors;
}

NodalValues read_field(const std::filesystem::path& path, const std::string& name, bool are_tensors) {
  const std::string kind = kind_of_file(path);
  const std::size_t width = are_tensors ? 6 : 1;
  NodalValues result;
  if (kind == ".vtu" || kind == ".msh") {
    FieldForm form;
    if (are_tensors) form.n_components = kind == ".vtu" ? std::vector{3, 4, 6, 9} : std::vector{9};
    auto [mesh, fields] = read_chosen(path, [&](const std::vector<MeshField>& all) {
      return std::vector{choose_field(all, name, path.string(), form)};
    });
    if (mesh.order > 1)
      refuse("{}: a field on elements of order {}: expected order 1", path.string(), mesh.order);
    require_straight(mesh, path.string());
    MeshField& field = fields[0];
    if (are_tensors) field.values = as_tensors(field.values, field.n_components);
    if (!field.is_of_points) field.values = means_at_points(mesh, field.values, width);
    result = {std::move(mesh), std::move(field.values)};
  } else {
    result = read_beside_mesh(path, width);
  }
  require_values(result, path.string());
  return result;
}

}  // namespace

void require_own_points(const Mesh& mesh, std::size_t n_points, const std::filesystem::path& path) {
  if (mesh.points.size() != n_points)
    refuse("{}: fields on quads of 8 nodes, or on cells of order 2: expected 4, 9, 16 or 25", path.string());
}

bool holds_values(const std::filesystem::path& path) {
  constexpr std::array kKinds = {".msh", ".vtu", ".sol", ".mtr", ".metric"};
  return std::ranges::find(kKinds, kind_of_file(path)) != kKinds.end();
}

MeshWithFields read_fields(const std::filesystem::path& path) {
  constexpr int kMostComponents = 9;
  return read_chosen(path, [&](const std::vector<MeshField>& all) {
    std::map<std::pair<bool, std::string>, std::size_t> last;
    for (std::size_t i = 0; i < all.size(); ++i) last[{all[i].is_of_points, all[i].name}] = i;
    std::vector<std::size_t> chosen;
    for (const auto& [key, i] : last) {
      if (kind_of_file(path) == ".msh" && all[i].n_components > kMostComponents)
        refuse("{}: the field {} has {} components: expected up to {}", path.string(),
               TextScanner::printable(all[i].name), all[i].n_components, kMostComponents);
      chosen.push_back(i);
    }
    return chosen;
  });
}

void write_fields(const std::filesystem::path& path, const Mesh& mesh, const std::vector<MeshField>& fields,
                  const MshOptions& options) {
  assert(std::ranges::all_of(fields, [&](const MeshField& field) {
    const std::size_t n = field.is_of_points ? mesh.points.size() : n_cells(mesh, dimension_of(mesh));
    return field.values.size() == n * static_cast<std::size_t>(field.n_components);
  }));
  check_mesh_format(path, options, mesh.order);
  const std::string kind = kind_of_file(path);
  if (kind == ".vtu")
    write_vtu(path, mesh, {}, fields);
  else if (kind == ".msh")
    write_file_atomically(path, [&](std::ostream& stream) { write_msh(stream, mesh, options, fields); });
  else
    refuse("{}: cannot hold fields: expected a .msh or .vtu file", path.string());
}

NodalValues read_values(const std::filesystem::path& path, const std::string& name) {
  return read_field(path, name, false);
}

NodalValues read_tensors(const std::filesystem::path& path, const std::string& name) {
  return read_field(path, name, true);
}

}  // namespace delquad
