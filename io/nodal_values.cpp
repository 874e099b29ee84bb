#include "io/nodal_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <unordered_map>

#include "base/located.h"
#include "base/text.h"
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
std::vector<double> in_order(const std::vector<std::pair<long long, double>>& values,
                             const std::vector<long long>& tags) {
  const std::unordered_map<long long, double> of_tag(values.begin(), values.end());
  std::vector<double> result;
  for (const long long tag : tags) {
    const auto found = of_tag.find(tag);
    result.push_back(found == of_tag.end() ? kNoValue : found->second);
  }
  return result;
}

/// One of the components of a field that has so many.
std::vector<std::pair<long long, double>> component(const msh::View& view, int k) {
  if (k == 0) return view.values;
  std::vector<std::pair<long long, double>> values = view.values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i].second =
        view.further[i * static_cast<std::size_t>(view.n_components - 1) + static_cast<std::size_t>(k - 1)];
  return values;
}

/// All components of a field of that form, those of a point side by side; of tensors, which are rows of three
/// by three, six. `name` becomes that of the field.
NodalValues read_msh_view(const std::filesystem::path& path, std::string& name, const FieldForm& form) {
  TextScanner scanner(path);
  refuse_other_kinds(scanner, "MSH");
  msh::Contents contents = msh::read_contents(scanner, true);
  const std::vector<msh::View> views = std::move(contents.views);
  std::vector<FieldInFile> fields;
  for (const msh::View& view : views) fields.push_back({view.name, view.is_of_nodes, view.n_components});
  const msh::View& view = views[choose_field(fields, name, path.string(), form)];
  name = view.name;
  std::vector<int> which;
  if (form.are_tensors) which = {0, 1, 2, 4, 5, 8};
  for (int c = 0; !form.are_tensors && c < view.n_components; ++c) which.push_back(c);
  msh::MeshTags tags;
  NodalValues result{msh::to_mesh(std::move(contents), scanner, &tags), {}};
  result.values.resize(which.size() * result.mesh.points.size());
  for (std::size_t c = 0; c < which.size(); ++c) {
    const auto values = component(view, which[c]);
    const std::vector<double> at_points =
        view.is_of_nodes
            ? in_order(values, tags.points)
            : means_at_points(result.mesh, in_order(values, tags.triangles), in_order(values, tags.quads));
    for (std::size_t i = 0; i < at_points.size(); ++i) result.values[which.size() * i + c] = at_points[i];
  }
  return result;
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
      refuse("{}: the field has no value at {}", file, show_point(p));
    }
  }
}

}  // namespace

std::size_t choose_field(const std::vector<FieldInFile>& fields, const std::string& name,
                         const std::string& file, const FieldForm& form) {
  std::set<std::string> names;
  for (const FieldInFile& field : fields) names.insert(TextScanner::printable(field.name));
  if (fields.empty())
    refuse("{}: has no field: expected $NodeData or $ElementData, or in a VTU file point data or cell data",
           file);
  if (name.empty() && names.size() > 1)
    refuse("{}: has the fields {}: say which, as {}:NAME", file, fmt::join(names, ", "),
           std::filesystem::path(file).filename().string());
  for (std::size_t i = fields.size(); i-- > 0;) {
    if (!name.empty() && fields[i].name != name) continue;
    if (form.of_points && !fields[i].is_of_points)
      refuse("{}: the field {} is of elements: expected one of points", file,
             TextScanner::printable(fields[i].name));
    if (std::ranges::find(form.n_components, fields[i].n_components) != form.n_components.end()) return i;
    refuse("{}: the field {} has {} components: expected {}", file, TextScanner::printable(fields[i].name),
           fields[i].n_components, fmt::join(form.n_components, ", "));
  }
  refuse("{}: has no field {}: expected {}", file, TextScanner::printable(name), fmt::join(names, ", "));
}

std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_triangles,
                                    const std::vector<double>& of_quads, std::size_t width) {
  std::vector<double> sum(width * mesh.points.size(), 0), weight(mesh.points.size(), 0);
  const auto add = [&](const auto& element, double size, const double* values) {
    for (const int v : element) {
      for (std::size_t k = 0; k < width; ++k) sum[width * v + k] += size * values[k];
      weight[v] += size;
    }
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    add(mesh.triangles[i], area(mesh, mesh.triangles[i]), &of_triangles[width * i]);
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) {
    const auto [a, b, c, d] = mesh.quads[i];
    add(mesh.quads[i], area(mesh, {a, b, c}) + area(mesh, {a, c, d}), &of_quads[width * i]);
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] = weight[i / width] > 0 ? sum[i] / weight[i / width] : kNoValue;
  return sum;
}

namespace {

NodalValues read_field(const std::filesystem::path& path, std::string name, bool are_tensors) {
  const std::string kind = kind_of_file(path);
  FieldForm form{{1}, false, are_tensors};
  if (are_tensors) form.n_components = kind == ".vtu" ? std::vector{3, 4, 6, 9} : std::vector{9};
  NodalValues field = kind == ".vtu"   ? read_vtu_field(path, name, form)
                      : kind == ".msh" ? read_msh_view(path, name, form)
                                       : read_beside_mesh(path, are_tensors ? 6 : 1);
  require_values(field, path.string());
  return field;
}

}  // namespace

bool holds_values(const std::filesystem::path& path) {
  constexpr std::array kKinds = {".msh", ".vtu", ".sol", ".mtr", ".metric"};
  return std::ranges::find(kKinds, kind_of_file(path)) != kKinds.end();
}

PointField read_point_field(const std::filesystem::path& path, const std::string& name) {
  const std::string kind = kind_of_file(path);
  if (kind != ".msh" && kind != ".vtu") refuse("{}: fields are read from .msh and .vtu files", path.string());
  std::string found = name;
  const FieldForm form{{1, 2, 3}, true};
  NodalValues all = kind == ".vtu" ? read_vtu_field(path, found, form) : read_msh_view(path, found, form);
  const std::size_t width = all.values.size() / std::max<std::size_t>(1, all.mesh.points.size());
  PointField field{std::move(all.mesh), {}};
  for (std::size_t c = 0; c < width; ++c) {
    std::vector<double>& values = field.components[width == 1 ? found : found + "_" + "xyz"[c]];
    for (std::size_t i = c; i < all.values.size(); i += width) values.push_back(all.values[i]);
  }
  return field;
}

void write_point_data(const std::filesystem::path& path, const Mesh& mesh, const PointData& data,
                      const MshOptions& options) {
  check_mesh_format(path, options, mesh.order);
  const std::string kind = kind_of_file(path);
  if (kind == ".vtu")
    write_vtu(path, mesh, {}, QuadNodes::kAll, data);
  else if (kind == ".msh")
    write_file_atomically(
        path, [&](std::ostream& stream) { write_msh(stream, mesh, options, QuadNodes::kAll, data); });
  else
    refuse("{}: values at points are written to .msh and .vtu files", path.string());
}

NodalValues read_values(const std::filesystem::path& path, const std::string& name) {
  return read_field(path, name, false);
}

NodalValues read_tensors(const std::filesystem::path& path, const std::string& name) {
  return read_field(path, name, true);
}

}  // namespace delquad
