// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/write_view.h"

#include <cmath>
#include <ostream>

#include "delquad/error.h"
#include "delquad/hexahedra.h"
#include "experiments/report/page.h"
#include "geometry/mesh/cell_shapes.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

Json entities_json(const std::vector<Entity>& entities) {
  Json json = Json::array();
  for (const Entity& entity : entities) json.push_back({{"tag", entity.tag}, {"names", entity.names}});
  return json;
}

Json points_json(const Mesh& mesh) {
  Json json = Json::array();
  for (const NamedPoint& point : mesh.named_points) {
    const Vec3& at = mesh.points[point.point];
    if (!point.entity.names.empty())
      json.push_back({{"names", point.entity.names}, {"at", {at.x, at.y, at.z}}});
  }
  return json;
}

}  // namespace

void write_view(const std::filesystem::path& file, const Mesh& mesh, const std::string& title,
                const ViewNotes& notes) {
  constexpr std::size_t kCloseups = 6;
  if (mesh.triangles.empty() && mesh.quads.empty() && mesh.lines.empty())
    throw InputError(title + ": there is nothing to show: no triangles, quads and lines");
  const MeshMetrics metrics = evaluate_metrics(mesh, nullptr);
  Json data = glossary_json();
  data["title"] = title;
  data["unit"] = mesh.unit;
  data["values"] = Json::object();
  const bool is_volume = is_solid(mesh);
  const CellMeasures cells = measure(mesh);
  if (is_volume)
    data["values"] = {{"n_elements", cells.count},
                      {"n_vertices", mesh.points.size()},
                      {"scaled_jacobian_min", cells.least_jacobian}};
  for (const auto& [key, value] : metrics.values)
    if (std::isfinite(value) && !is_volume) data["values"][key] = value;
  data["cells"] = Json::array();
  for_each_shape(mesh, [&](const SolidShape& shape, const auto& all, const auto&) {
    data["cells"].push_back({{"name", shape.plural}, {"number", all.size()}});
  });
  data["eta"] = metrics.eta.counts;
  data["warnings"] = notes.warnings;
  data["closeups"] = is_volume ? Json::array() : closeups_json(mesh, kCloseups);
  data["regions"] = entities_json(mesh.regions);
  if (is_volume) data["regions"].push_back({{"tag", 0}, {"names", {"inside"}}});
  data["curves"] = entities_json(mesh.curves);
  data["points"] = points_json(mesh);
  write_file_atomically(file, [&](std::ostream& out) {
    begin_page(out, "Delquad: a mesh", std::string(kPageStyle) + std::string(kViewStyle), kViewBody);
    data["mesh"] = add_picture(out, "mesh", pack_mesh(mesh, notes.failing, true));
    const bool in_space = data["mesh"]["dimension"] == 3;
    end_page(out, std::move(data), in_space, kViewScript);
  });
}

}  // namespace delquad
