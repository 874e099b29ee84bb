// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program/print.h"

namespace delquad {
namespace {

using Json = nlohmann::ordered_json;

Json entities_json(const std::vector<Entity>& entities, const std::vector<int>& entity_of,
                   const char* items) {
  std::vector<long long> counts(entities.size(), 0);
  for (const int e : entity_of) ++counts[e];
  Json all = Json::array();
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (counts[i] > 0)
      all.push_back({{"number", entities[i].tag}, {"names", entities[i].names}, {items, counts[i]}});
  return all;
}

}  // namespace

std::string hexahedra_record(const std::string& source, const Mesh& mesh, const HexMeasures& measures) {
  const Json json = {{"mesh", source},
                     {"points", mesh.points.size()},
                     {"hexahedra", mesh.hexahedra.size()},
                     {"least_scaled_jacobian", measures.least_jacobian},
                     {"mean_scaled_jacobian", measures.mean_jacobian},
                     {"unproven", measures.unproven},
                     {"volume", measures.volume},
                     {"unit", mesh.unit.empty() ? Json() : Json(mesh.unit)},
                     {"volumes", entities_json(mesh.volumes, mesh.hex_volume, "hexahedra")},
                     {"faces", entities_json(mesh.regions, mesh.quad_region, "quads")},
                     {"curves", entities_json(mesh.curves, mesh.line_curve, "lines")}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void print_hexahedra(const Mesh& mesh, const HexMeasures& measures) {
  fmt::print("  {:<10} {:>12}\n  {:<10} {:>12}\n", "hexahedra", mesh.hexahedra.size(), "points",
             mesh.points.size());
  fmt::print("  {:<10} {:>12.6g} least\n  {:<10} {:>12.6g} mean\n", "scaled J", measures.least_jacobian,
             "scaled J", measures.mean_jacobian);
  fmt::print("  {:<10} {:>12} hexahedra: not proven to be positive\n", "unproven", measures.unproven);
  fmt::print("  {:<10} {:>12.9g}{}\n", "volume", measures.volume,
             mesh.unit.empty() ? "" : " " + mesh.unit + "^3");
}

}  // namespace delquad
