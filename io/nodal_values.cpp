#include "io/nodal_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "base/located.h"
#include "base/text.h"
#include "io/formats/msh_raw.h"

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

NodalValues read_msh_view(const std::filesystem::path& path, const std::string& name) {
  TextScanner scanner(path);
  refuse_other_kinds(scanner, "MSH");
  msh::Contents contents = msh::read_contents(scanner, true);
  const std::vector<msh::View> views = std::move(contents.views);
  std::vector<FieldInFile> fields;
  for (const msh::View& view : views) fields.push_back({view.name, view.is_of_nodes, view.n_components});
  const msh::View& view = views[choose_field(fields, name, path.string())];
  msh::MeshTags tags;
  NodalValues result{msh::to_mesh(std::move(contents), scanner, &tags), {}};
  result.values = view.is_of_nodes ? in_order(view.values, tags.points)
                                   : means_at_points(result.mesh, in_order(view.values, tags.triangles),
                                                     in_order(view.values, tags.quads));
  return result;
}

/// Lines' own points, which a field on faces says nothing of, go.
void require_values(NodalValues& field, const std::string& file) {
  std::vector<char> is_used(field.mesh.points.size(), 0);
  for (const auto& e : field.mesh.triangles)
    for (const int v : e) is_used[v] = 1;
  for (const auto& e : field.mesh.quads)
    for (const int v : e) is_used[v] = 1;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) {
      field.values[i] = 1;  // is never asked for
    } else if (std::isnan(field.values[i])) {
      const Vec3& p = field.mesh.points[i];
      refuse("{}: the field has no value at {}", file, show_point(p));
    }
  }
}

}  // namespace

std::size_t choose_field(const std::vector<FieldInFile>& fields, const std::string& name,
                         const std::string& file) {
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
    if (fields[i].n_components == 1) return i;
    refuse("{}: the field {} has {} components: expected one", file, TextScanner::printable(fields[i].name),
           fields[i].n_components);
  }
  refuse("{}: has no field {}: expected {}", file, TextScanner::printable(name), fmt::join(names, ", "));
}

std::vector<double> means_at_points(const Mesh& mesh, const std::vector<double>& of_triangles,
                                    const std::vector<double>& of_quads) {
  std::vector<double> sum(mesh.points.size(), 0), weight(mesh.points.size(), 0);
  const auto add = [&](const auto& element, double size, double value) {
    for (const int v : element) {
      sum[v] += size * value;
      weight[v] += size;
    }
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    add(mesh.triangles[i], area(mesh, mesh.triangles[i]), of_triangles[i]);
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) {
    const auto [a, b, c, d] = mesh.quads[i];
    add(mesh.quads[i], area(mesh, {a, b, c}) + area(mesh, {a, c, d}), of_quads[i]);
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = weight[i] > 0 ? sum[i] / weight[i] : kNoValue;
  return sum;
}

bool holds_values(const std::filesystem::path& path) {
  const std::string kind = kind_of_file(path);
  return kind == ".msh" || kind == ".vtu";
}

NodalValues read_values(const std::filesystem::path& path, const std::string& name) {
  NodalValues field = kind_of_file(path) == ".vtu" ? read_vtu_field(path, name) : read_msh_view(path, name);
  require_values(field, path.string());
  return field;
}

}  // namespace delquad
