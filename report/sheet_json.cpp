#include "report/sheet_json.h"

#include <fmt/format.h>

#include <cmath>

#include "report/closeup.h"
#include "report/page_json.h"

namespace delquad {
namespace {

using namespace nlohmann::literals;

constexpr std::size_t kCloseups = 3;
/// Curves of convergence a cell has at most: of its largest patches nothing is known here, so the first ones.
constexpr std::size_t kMostCurves = 12;

/// Whole numbers take little room.
long long hundredths(double value) { return std::llround(value * 100); }

Json energies_json(const Json& energies) {
  Json json = Json::array();
  for (const Json& e : energies) json.push_back(e.is_null() ? Json() : brief_number(e.get<double>()));
  return json;
}

/// How many quads are around the vertices inside: shares as d4 counts them, of all vertices inside. Those
/// with a triangle have an entry of their own.
Json valences_json(const Json& record) {
  const Json& all = record.at("valences");
  const Json& metrics = record.at("metrics");
  const bool has_quads = metrics.value("n_quads", 0.0) > 0;
  if (!has_quads || !record.contains("quad_valences"))
    return {{"of", has_quads ? "elements" : "triangles"}, {"counts", all}, {"mixed", 0}};
  long long mixed = 0;
  for (const Json& count : all) mixed += count.get<long long>();
  for (const Json& count : record["quad_valences"]) mixed -= count.get<long long>();
  return {{"of", "quads"}, {"counts", record["quad_valences"]}, {"mixed", mixed}};
}

Json closeups_json(const Mesh& mesh) {
  Json json = Json::array();
  for (const Closeup& closeup : worst_quads(mesh, kCloseups)) {
    Json points = Json::array(), etas = Json::array();
    for (const Vec2& p : closeup.points) points.push_back({hundredths(p.x), hundredths(p.y)});
    for (const double eta : closeup.etas) etas.push_back(hundredths(eta));
    json.push_back({{"eta", closeup.eta},
                    {"size", closeup.size},
                    {"normal", {closeup.normal.x, closeup.normal.y, closeup.normal.z}},
                    {"at", {closeup.at.x, closeup.at.y, closeup.at.z}},
                    {"points", points},
                    {"elements", closeup.elements},
                    {"etas", etas}});
  }
  return json;
}

Json surface_facts(const Json& surface) {
  const auto count = [&](const char* pointer) {
    return surface.at(Json::json_pointer(pointer)).get<long long>();
  };
  const auto distance = [&](const char* which) {
    return surface.at("distances_in_diagonals").at(which).at("max").get<double>();
  };
  return Json::array(
      {{"watertight", surface.at("/topology/watertight"_json_pointer).get<bool>()
                          ? "yes"
                          : fmt::format("no: {} free edges", count("/topology/free_edges"))},
       {"Euler characteristic, mesh and model", fmt::format("{}, {}", count("/topology/euler_characteristic"),
                                                            count("/model_topology/euler_characteristic"))},
       {"nonconforming edges", fmt::format("{}", count("/nonconforming_edges"))},
       {"cuts", fmt::format("{}", surface.at("cuts").size())},
       {"farthest from mesh to surface, surface to mesh, in diagonals of the model",
        fmt::format("{:.1e}, {:.1e}", distance("mesh_to_surface"), distance("surface_to_mesh"))}});
}

std::string size_text(const Json& size) {
  std::string text = size.at("base").is_null() ? "" : size.at("base").get<std::string>();
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (const auto n = size.at("sources").size(); n > 0) add(fmt::format("{} sources", n));
  for (const Json& named : size.value("on", Json::array()))
    add(fmt::format("'{}' {}", named.at("name").get<std::string>(), named.at("size").get<double>()));
  for (const char* key : {"gradation", "curvature", "min", "max"})
    if (const Json value = size.value(key, Json()); !value.is_null())
      add(fmt::format("{} {}", key, value.get<double>()));
  return text.empty() ? "as the model says" : text;
}

}  // namespace

Json cell_json(const Json& record, const std::optional<Mesh>& mesh) {
  Json json = {{"word", record.at("pipeline")}, {"status", record.at("status")}};
  if (record.contains("peer"))
    json["peer"] = {{"version", record["peer"].at("version")}, {"command", record["peer"].at("command")}};
  if (json["status"] != "ok") {
    json["reason"] = record.at("reason");
    return json;
  }
  json["values"] = record.at("metrics");
  if (const Json& clock = record.at("meshing_seconds"); !clock.is_null()) json["values"]["seconds"] = clock;
  json["steps"] = record.value("seconds", Json::object());
  json["eta"] = record.at("eta_histogram").at("counts");
  json["valences"] = valences_json(record);
  json["warnings"] = record.value("warnings", Json::array());
  if (record.contains("surface")) json["surface"] = surface_facts(record["surface"]);
  if (record.contains("smoothing")) {
    const Json& curves = record["smoothing"].at("energy_by_evaluation");
    json["patches"] = curves.size();
    json["energy"] = Json::array();
    for (std::size_t i = 0; i < std::min(curves.size(), kMostCurves); ++i)
      json["energy"].push_back(energies_json(curves[i]));
  }
  if (mesh && !mesh->quads.empty()) json["closeups"] = closeups_json(*mesh);
  return json;
}

Json facts_json(const Json& record) {
  Json facts = Json::array();
  facts.push_back({"model", record.at("model")});
  const Json options = record.value("options", Json::object());
  if (options.contains("size")) facts.push_back({"size", size_text(options["size"])});
  if (options.contains("cross")) facts.push_back({"directions", options["cross"]});
  if (record.contains("domain")) facts.push_back({"patches", record["domain"].at("patches").dump()});
  return facts;
}

}  // namespace delquad
