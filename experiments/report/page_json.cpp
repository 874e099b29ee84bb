// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

#include "delquad/extend.h"
#include "experiments/report/packed_mesh.h"
#include "experiments/sweep/experiment.h"
#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "io/svg.h"
#include "metrics/metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"

namespace delquad {

namespace {

Json values_json(const std::map<std::string, double>& values) {
  Json json = Json::object();
  for (const auto& [key, value] : values)
    if (!std::isnan(value)) json[key] = value;
  return json;
}

Json law_json(const std::vector<double>& elements, const std::vector<double>& seconds) {
  constexpr std::size_t kFewestSizes = 3;
  constexpr double kLeastRatio = 4;
  const std::set<double> sizes(elements.begin(), elements.end());
  if (sizes.size() < kFewestSizes || *sizes.rbegin() < kLeastRatio * *sizes.begin()) return Json();
  const auto law = fit_power_law(elements, seconds);
  return law ? Json{{"factor", law->factor}, {"exponent", law->exponent}} : Json();
}

const char* name_of(Better better) {
  switch (better) {
    case Better::kHigher:
      return "higher";
    case Better::kLower:
      return "lower";
    case Better::kNeither:
      return "";
  }
  return "";
}

constexpr const char* kSeed = "seed";

bool is_known(const std::vector<CellRecord>& records, const std::string& key) {
  return std::ranges::any_of(records,
                             [&](const CellRecord& record) { return std::isfinite(value_of(record, key)); });
}

/// Numbers texts in the order in which they come.
class Names {
 public:
  std::size_t of(const std::string& name) {
    const auto [at, is_new] = places_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return at->second;
  }
  const Json& list() const { return names_; }

 private:
  std::map<std::string, std::size_t> places_;
  Json names_ = Json::array();
};

/// The texts of a table's files by extension, packed: what one saves from the page is what a run writes.
Json table_files_json(const Table& table) {
  Json json = Json::object();
  for (const auto& [extension, print] : table_formats())
    if (const std::string name = extension; name != ".json") json[name.substr(1)] = packed_text(print(table));
  return json;
}

}  // namespace

Json table_json(const Table& table) {
  if (table.rows.empty()) return Json();
  Json json = json_without_rows(table);
  json["files"] = table_files_json(table);
  if (!table.shown.empty()) json["shown"] = table.shown;
  for (const TableRow& row : table.rows) {
    json["rows"].push_back({{"group", row.group},
                            {"name", shown_name(row)},
                            {"values", values_json(row.values)},
                            {"published", values_json(row.published)},
                            {"half_widths", values_json(row.half_widths)},
                            {"bold", row.bold},
                            {"texts", row.texts},
                            {"source", row.source},
                            {"failure", row.failure},
                            {"skipped", row.skipped}});
  }
  return json;
}

std::optional<PowerLaw> fit_power_law(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> u, v;
  for (const double value : x) u.push_back(std::log(value));
  for (const double value : y) v.push_back(std::log(value));
  const double u0 = mean(u), v0 = mean(v);
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    squares += (u[i] - u0) * (u[i] - u0);
    products += (u[i] - u0) * (v[i] - v0);
  }
  if (!(squares > 0)) return std::nullopt;
  return PowerLaw{std::exp(v0 - products / squares * u0), products / squares};
}

Json growth_json(const std::vector<CellRecord>& records) {
  struct Line {
    std::string word, name;
    std::vector<double> elements, seconds;
    Json points = Json::array();
  };
  std::vector<Line> lines;
  for (const CellRecord& record : records) {
    const auto n = record.values.find("n_elements"), s = record.values.find("seconds_total");
    if (n == record.values.end() || s == record.values.end() || !(n->second > 0) || !(s->second > 0))
      continue;
    auto line = std::ranges::find_if(
        lines, [&](const Line& l) { return l.word == record.pipeline && l.name == record.name; });
    if (line == lines.end()) line = lines.insert(lines.end(), {record.pipeline, record.name, {}, {}});
    line->elements.push_back(n->second);
    line->seconds.push_back(s->second);
    line->points.push_back({n->second, s->second, record.group});
  }
  Json json = Json::array();
  for (const Line& line : lines)
    json.push_back({{"word", line.word},
                    {"case", line.name},
                    {"points", line.points},
                    {"law", law_json(line.elements, line.seconds)}});
  return json;
}

Json glossary_json() {
  constexpr int kColours = 64;
  Json json = {{"letters", Json::array()}, {"metrics", Json::array()}, {"colours", Json::array()}};
  for (const Stage& stage : stage_registry())
    json["letters"].push_back({{"letter", std::string(1, stage.letter)}, {"name", stage.name}});
  for (const Metric& metric : metric_registry())
    json["metrics"].push_back({{"key", metric.key},
                               {"title", metric.title},
                               {"unit", metric.unit},
                               {"better", name_of(metric.better)},
                               {"source", metric.source}});
  json["steps"] = Json::array();
  for (const StepTime& time : step_times_of_tables())
    if (*time.step != 0) json["steps"].push_back(time.step);
  json["steps"].push_back("peer");
  for (int k = 0; k < kColours; ++k) json["colours"].push_back(svg::colour((k + 0.5) / kColours));
  json["marks"] = {{"one less", svg::mark_colour(1)},
                   {"one more", svg::mark_colour(-1)},
                   {"other", svg::mark_colour(0)},
                   {"pair", svg::kPairColour}};
  return json;
}

std::string seed_of(const CellRecord& record) {
  for (const auto& [title, value] : record.variant)
    if (title == kSeed) return value;
  return "";
}

Json means_json(std::span<const CellRecord* const> cells, const std::vector<TableColumn>& columns) {
  std::vector<std::pair<std::string, std::vector<const CellRecord*>>> words;
  for (const CellRecord* cell : cells) {
    if (!cell->reason.empty()) continue;
    auto word = std::ranges::find(words, cell->pipeline, [](const auto& w) { return w.first; });
    if (word == words.end()) word = words.insert(words.end(), {cell->pipeline, {}});
    word->second.push_back(cell);
  }
  Json json = Json::array();
  if (std::ranges::none_of(words, [](const auto& w) { return w.second.size() > 1; })) return json;
  for (const auto& [word, done] : words) {
    Json line = {
        {"word", word}, {"n", done.size()}, {"values", Json::object()}, {"half_widths", Json::object()}};
    for (const TableColumn& column : columns) {
      std::vector<double> values;
      for (const CellRecord* cell : done)
        if (const double v = value_of(*cell, column.key); std::isfinite(v)) values.push_back(v);
      if (!values.empty()) line["values"][column.key] = mean(values);
      if (values.size() > 1) line["half_widths"][column.key] = confidence_half_width(values);
    }
    json.push_back(std::move(line));
  }
  return json;
}

Json samples_json(const std::vector<CellRecord>& records, const std::vector<TableColumn>& columns) {
  Json keys = Json::array(), cells = Json::array(), cases = Json::array();
  for (const TableColumn& column : columns)
    if (is_known(records, column.key)) keys.push_back({{"key", column.key}, {"title", column.title}});
  Names sheets, words;
  for (const CellRecord& record : records) {
    if (!record.reason.empty()) continue;
    Json cell = {sheets.of(row_group(record)), words.of(record.pipeline)};
    if (cases.size() < sheets.list().size()) cases.push_back(record.name);
    for (const Json& key : keys)
      cell.push_back(brief_number(value_of(record, key["key"].get<std::string>())));
    cells.push_back(std::move(cell));
  }
  return {
      {"sheets", sheets.list()}, {"cases", cases}, {"words", words.list()}, {"keys", keys}, {"cells", cells}};
}

Json brief_number(double value) {
  if (!std::isfinite(value)) return Json();
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

namespace {

constexpr int kRings = 3;

std::vector<int> vertices_of(const Mesh& mesh, int element) {
  const int n = static_cast<int>(mesh.triangles.size());
  if (element >= n) return {mesh.quads[element - n].begin(), mesh.quads[element - n].end()};
  return {mesh.triangles[element].begin(), mesh.triangles[element].end()};
}

/// The quads in question, worst first.
std::vector<int> pick(const Mesh& mesh, const std::vector<double>& eta, std::size_t count) {
  std::vector<int> order(mesh.quads.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int q) { return eta[q]; });
  std::vector<int> picked;
  std::set<int> taken;
  for (const int q : order) {
    if (picked.size() == count) break;
    if (std::ranges::any_of(mesh.quads[q], [&](int v) { return taken.contains(v); })) continue;
    taken.insert(mesh.quads[q].begin(), mesh.quads[q].end());
    picked.push_back(q);
  }
  return picked;
}

/// Elements within kRings of an element, itself first.
class Surroundings {
 public:
  explicit Surroundings(const Mesh& mesh) : mesh_(mesh), start_(mesh.points.size() + 1, 0) {
    for_each_element(mesh, [&](int, const auto& v) {
      for (const int i : v) ++start_[i + 1];
    });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    around_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> next = start_;
    for_each_element(mesh, [&](int element, const auto& v) {
      for (const int i : v) around_[next[i]++] = element;
    });
  }

  std::vector<int> of(int element) const {
    std::vector<int> found = {element};
    std::set<int> known = {element};
    std::size_t first = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      const std::size_t end = found.size();
      for (; first < end; ++first)
        for (const int v : vertices_of(mesh_, found[first]))
          for (int k = start_[v]; k < start_[v + 1]; ++k)
            if (known.insert(around_[k]).second) found.push_back(around_[k]);
    }
    return found;
  }

 private:
  const Mesh& mesh_;
  std::vector<int> start_, around_;  // elements by vertex
};

/// Maps space to the plane of a quad, in units of its mean edge.
struct View {
  Vec3 centre{0, 0, 0}, right, up, normal;
  double unit;
  explicit View(const Mesh& mesh, const std::array<int, 4>& v) {
    const auto& p = mesh.points;
    double edges = 0;
    for (int k = 0; k < 4; ++k) {
      centre = centre + 0.25 * p[v[k]];
      edges += norm(p[v[(k + 1) % 4]] - p[v[k]]);
    }
    unit = edges > 0 ? 4 / edges : 1;
    normal = cross(p[v[2]] - p[v[0]], p[v[3]] - p[v[1]]);
    if (!(norm(normal) > 0)) normal = {0, 0, 1};
    normal = (1 / norm(normal)) * normal;
    const bool is_flat = std::abs(normal.z) > 1 - 1e-9;  // then as the mesh lies
    right = is_flat ? Vec3{1, 0, 0} : cross(Vec3{0, 0, 1}, normal);
    right = (unit / norm(right)) * right;
    up = is_flat ? Vec3{0, unit, 0} : cross(normal, right);
  }
  Vec2 operator()(const Vec3& p) const { return {dot(p - centre, right), dot(p - centre, up)}; }
};

Closeup look_at(const Mesh& mesh, const std::vector<double>& eta, const Surroundings& surroundings,
                int quad) {
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  const View view(mesh, mesh.quads[quad]);
  Closeup closeup{eta[quad], 1 / view.unit, view.normal, view.centre, {}, {}, {}};
  std::map<int, int> number;
  for (const int element : surroundings.of(n_triangles + quad)) {
    std::vector<int> corners = element < n_triangles
                                   ? vertices_of(mesh, element)
                                   : nodes_around(mesh, static_cast<std::size_t>(element - n_triangles));
    for (int& v : corners) {
      const auto [at, is_new] = number.try_emplace(v, static_cast<int>(number.size()));
      if (is_new) closeup.points.push_back(view(mesh.points[v]));
      v = at->second;
    }
    closeup.elements.push_back(std::move(corners));
    closeup.etas.push_back(element < n_triangles ? 1 : eta[element - n_triangles]);
  }
  return closeup;
}

}  // namespace

std::vector<Closeup> worst_quads(const Mesh& mesh, std::size_t count) {
  const std::vector<double> eta = quad_etas(mesh);
  const Surroundings surroundings(mesh);
  std::vector<Closeup> closeups;
  for (const int q : pick(mesh, eta, count)) closeups.push_back(look_at(mesh, eta, surroundings, q));
  return closeups;
}

namespace {

using namespace nlohmann::literals;

constexpr std::size_t kCloseupsOfCell = 3;
/// Curves of convergence a cell has at most: of its largest patches nothing is known here, so the first ones.
constexpr std::size_t kMostCurves = 12;

/// Whole numbers take little room.
long long hundredths(double value) { return std::llround(value * 100); }

Json energies_json(const Json& energies) {
  Json json = Json::array();
  for (const Json& e : energies) json.push_back(e.is_null() ? Json() : brief_number(e.get<double>()));
  return json;
}

/// Returns shares of the vertices inside by the number of quads around them, as d4 counts them. Vertices with
/// a triangle have an entry of their own.
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
  if (const auto n = size.at("source").size(); n > 0) add(fmt::format("{} sources", n));
  for (const Json& named : size.value("on", Json::array()))
    add(fmt::format("'{}' {}", named.at("name").get<std::string>(), named.at("size").get<double>()));
  for (const char* key : {"gradation", "curvature", "min", "max"})
    if (const double value = size.value(key, 0.0); value > 0) add(fmt::format("{} {}", key, value));
  return text.empty() ? "as the model says" : text;
}

}  // namespace

Json closeups_json(const Mesh& mesh, std::size_t count) {
  Json json = Json::array();
  for (const Closeup& closeup : worst_quads(mesh, count)) {
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

Json cell_json(const Json& record, const std::optional<Mesh>& mesh) {
  Json json = {{"word", record.at("pipeline")}, {"status", record.at("status")}};
  if (record.contains("peer"))
    json["peer"] = {{"version", record["peer"].at("version_line")},
                    {"command", record["peer"].at("command")}};
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
  if (mesh && !mesh->quads.empty()) json["closeups"] = closeups_json(*mesh, kCloseupsOfCell);
  return json;
}

Json facts_json(const Json& record) {
  Json facts = Json::array();
  facts.push_back({"model", record.at("model")});
  if (const Json problem = record.value("problem", Json::object()); !problem.empty()) {
    facts.push_back({"size", size_text(problem.at("size"))});
    const Json& cross = problem.at("cross");
    const Json& given = cross.at(cross.at("text").is_null() ? "kind" : "text");
    facts.push_back({"directions", given.is_null() ? "boundary" : given});
  }
  if (record.contains("domain")) facts.push_back({"patches", record["domain"].at("patches").dump()});
  return facts;
}

}  // namespace delquad
