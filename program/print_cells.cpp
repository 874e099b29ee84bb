// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "program/print.h"

namespace delquad {
namespace {

using Json = nlohmann::ordered_json;

/// Entities with the number of their elements of each kind; those without any are left out.
Json entities_json(const std::vector<Entity>& entities,
                   std::initializer_list<std::pair<const char*, const std::vector<int>&>> kinds) {
  std::vector<Json> all;
  for (const Entity& entity : entities) all.push_back({{"number", entity.tag}, {"names", entity.names}});
  for (const auto& [kind, entity_of] : kinds) {
    std::vector<long long> counts(all.size(), 0);
    for (const int e : entity_of) ++counts[e];
    for (std::size_t e = 0; e < all.size(); ++e)
      if (counts[e] > 0) all[e][kind] = counts[e];
  }
  std::erase_if(all, [](const Json& entity) { return entity.size() == 2; });
  return all;
}

}  // namespace

std::string cells_record(const std::string& source, const Mesh& mesh, const CellMeasures& measures,
                         const std::vector<std::string>& defects) {
  Json json = {{"mesh", source}, {"points", mesh.points.size()}};
  for (const ShapeMeasures& shape : measures.shapes) json[shape.name] = shape.count;
  json["least_scaled_jacobian"] = measures.least_jacobian;
  json["mean_scaled_jacobian"] = measures.mean_jacobian;
  json["unproven"] = measures.unproven;
  json["volume"] = measures.volume;
  json["shapes"] = Json::object();
  for (const ShapeMeasures& shape : measures.shapes)
    json["shapes"][shape.name] = {{"number", shape.count},
                                  {"volume", shape.volume},
                                  {"least_scaled_jacobian", shape.least_jacobian},
                                  {"mean_scaled_jacobian", shape.mean_jacobian}};
  json["defects"] = defects;
  json["unit"] = mesh.unit.empty() ? Json() : Json(mesh.unit);
  json["volumes"] = entities_json(mesh.volumes, {{"hexahedra", mesh.hex_volume},
                                                 {"prisms", mesh.prism_volume},
                                                 {"pyramids", mesh.pyramid_volume},
                                                 {"tetrahedra", mesh.tet_volume}});
  json["faces"] =
      entities_json(mesh.regions, {{"triangles", mesh.triangle_region}, {"quads", mesh.quad_region}});
  json["curves"] = entities_json(mesh.curves, {{"lines", mesh.line_curve}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void print_cells(const Mesh& mesh, const CellMeasures& measures, const std::vector<std::string>& defects) {
  for (const ShapeMeasures& shape : measures.shapes)
    fmt::print("  {:<10} {:>12} with {:.4g} % of the volume; scaled J {:.6g} least, {:.6g} mean\n",
               shape.name, shape.count, 100 * shape.volume / measures.volume, shape.least_jacobian,
               shape.mean_jacobian);
  fmt::print("  {:<10} {:>12}\n", "points", mesh.points.size());
  fmt::print("  {:<10} {:>12} cells: not proven to be positive\n", "unproven", measures.unproven);
  fmt::print("  {:<10} {:>12.9g}{}\n", "volume", measures.volume,
             mesh.unit.empty() ? "" : " " + mesh.unit + "^3");
  for (const std::string& defect : defects) fmt::print("  {:<10} {}\n", "unsound", defect);
}

}  // namespace delquad
