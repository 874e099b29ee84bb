// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/record.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "base/parallel.h"
#include "base/warning.h"
#include "delquad/error.h"
#include "experiments/sweep/experiment_fields.h"
#include "io/cases/problem_record.h"
#include "metrics/anisotropic_measures.h"
#include "metrics/judgement/criteria.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/result_records.h"

namespace delquad {
namespace {

using Json = nlohmann::ordered_json;

Json point_json(const Vec3& p) { return {p.x, p.y, p.z}; }

void add_times(Json& json, const StepTimes& times) {
  Json seconds = Json::object(), cpu = Json::object();
  for (const auto& [step, time] : times) {
    seconds[step] = time.seconds;
    if (time.cpu > 0) cpu[step] = time.cpu;
  }
  json["seconds"] = seconds;
  json["cpu_seconds"] = cpu;
}

Json domain_json(const Prepared& p) {
  std::size_t edges = 0;
  for (std::size_t i = 0; i < p.n_patches(); ++i) edges += p.patch(i).edges.size();
  Json json = {
      {"patches", p.n_patches()}, {"boundary_edges", edges}, {"expected_quads", p->size.expected_quads}};
  json["size_adapted_to"] = p->size.adapted_to;
  for (const SymmetryPlane& plane : p->symmetry)
    json["symmetry"].push_back({{"point", point_json(plane.point)}, {"normal", point_json(plane.normal)}});
  if (!p.is_surface()) json["background_triangles"] = p.background()->triangles.size();
  return json;
}

Json cross_json(const Prepared& p) {
  Json json = {{"singularities", Json::array()}};
  for (const PlacedSingularity& s : p->crosses.singularities)
    json["singularities"].push_back({{"at", point_json(s.at)}, {"index_quarters", s.index}});
  if (p->crosses.index_sum_and_expected) {
    json["index_sum_quarters"] = p->crosses.index_sum_and_expected->first;
    json["euler_characteristic_quarters"] = p->crosses.index_sum_and_expected->second;
  }
  json["row_ends"] = p.row_ends();
  if (p->crosses.dislocations)
    json["expected_dislocations"] = {{"boundary", p->crosses.dislocations->first},
                                     {"size_aware", p->crosses.dislocations->second}};
  return json;
}

Json histogram_json(const Histogram& h) { return {{"low", h.low}, {"high", h.high}, {"counts", h.counts}}; }

void add_metrics(Json& json, const MeshMetrics& metrics) {
  Json values = Json::object();
  for (const Metric& metric : metric_registry())
    if (const auto at = metrics.values.find(metric.key); at != metrics.values.end())
      values[metric.key] = at->second;
  for (const auto& [key, value] : metrics.values)
    if (!values.contains(key)) values[key] = value;
  json["metrics"] = values;
  if (!metrics.failures.empty()) json["failed_metrics"] = metrics.failures;
  json["eta_histogram"] = histogram_json(metrics.eta);
  json["angle_histogram"] = histogram_json(metrics.angle);
  const auto counts_json = [](const std::map<int, long long>& counts) {
    Json result = Json::object();
    for (const auto& [valence, count] : counts) result[std::to_string(valence)] = count;
    return result;
  };
  json["valences"] = counts_json(metrics.valences);
  json["quad_valences"] = counts_json(metrics.quad_valences);
  if (metrics.pairs) {
    Json burgers = Json::object();
    for (const auto& [rows, count] : metrics.pairs->burgers)
      burgers[std::to_string(rows[0]) + "," + std::to_string(rows[1])] = count;
    json["irregular_pairs"] = {{"pairs", metrics.pairs->pairs},
                               {"unpaired", metrics.pairs->unpaired},
                               {"burgers", burgers},
                               {"edges", counts_json(metrics.pairs->edges)}};
  }
}

Json metric_json(const CellIdentity::IdentifiedMetric& of_cell) {
  Json json = record_of(*of_cell.metric);
  json["content"] = of_cell.files;
  return json;
}

/// The measures that the project itself does not have, so that tables can be made from records alone.
Json added_metrics_json(const MeshMetrics& metrics, const CellIdentity* cell) {
  Json json = Json::array();
  for (const auto* more : {&criteria_metrics(), &anisotropic_measures()})
    for (const Metric& metric : *more)
      if (metrics.values.contains(metric.key)) json.push_back(record_of(metric));
  for (const AddedMetric& own : added_metrics()) json.push_back(record_of(*find_metric(own.key)));
  if (cell != nullptr)
    for (const auto& metric : cell->metrics) json.push_back(metric_json(metric));
  if (cell != nullptr)
    for (const std::string& solver : cell->solvers)
      for (const Metric& metric : metrics_of_solver(solver)) json.push_back(record_of(metric));
  return json;
}

Json fields_json(const SummaryStep& step) {
  Json json = Json::object();
  for (const SummaryField& field : step.fields)
    json[field.key] = std::visit([](const auto& value) { return Json(value); }, field.value);
  return json;
}

/// Adds the summaries of the steps, by step. Throws InputError if an added step has the name of another part.
void add_summaries(Json& json, const Summaries& summaries) {
  for (const SummaryStep& step : summaries.steps()) {
    if (json.contains(step.name))
      throw InputError("a stage calls its summary '" + step.name + "', as another part of records is called");
    json[step.name] = fields_json(step);
  }
}

/// Quads below kBadEta, and the corners of the model that forbid more.
Json bad_quads_json(const MeshResult& result) {
  const Preparation& p = *result.prepared;
  Json corners = Json::array();
  for (const SharpCorner& c : result.prepared.sharp_corners())
    corners.push_back({{"face", p.boundary.regions[c.face].tag},
                       {"curves", {p.boundary.curves[c.curves[0]].tag, p.boundary.curves[c.curves[1]].tag}},
                       {"at", point_json(p.boundary.points[c.node])},
                       {"angle_degrees", c.angle * 180 / std::numbers::pi},
                       {"eta_bound", c.eta_bound}});
  return {{"eta_below", kBadEta},
          {"in_sharp_corners", result.bad_in_corners},
          {"elsewhere", result.bad_elsewhere},
          {"sharp_corners", corners}};
}

/// Quads that are beyond any limit, by their places in a file that has them by regions (MSH), from 0.
Json failing_quads(const CriteriaReport& report, const Mesh& mesh) {
  std::vector<int> order(mesh.quads.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int q) { return mesh.quad_region[q]; });
  std::vector<char> fails(mesh.quads.size(), 0);
  const int n_triangles = static_cast<int>(mesh.triangles.size());
  for (const CriterionResult& result : report.results)
    for (const int e : result.failing)
      if (e >= n_triangles) fails[e - n_triangles] = 1;
  Json failing = Json::array();
  for (std::size_t i = 0; i < order.size(); ++i)
    if (fails[order[i]]) failing.push_back(i);
  return failing;
}

Json report_json(const CriteriaReport& report, const Mesh& mesh) {
  Json limits = Json::array();
  for (const CriterionResult& r : report.results) {
    Json json = record_of(r.limit);
    json["failing"] = r.failing.size();
    json["worst"] = r.worst;
    json["at"] = point_json(r.at.at);
    json["cause"] = r.cause;
    limits.push_back(json);
  }
  Json cures = Json::array();
  for (const Cure& cure : report.cures)
    cures.push_back({{"cause", cure.cause}, {"key", cure.key}, {"value", cure.value}, {"count", cure.count}});
  return {{"elements", report.elements},
          {"failing", report.failing},
          {"failing_quads", failing_quads(report, mesh)},
          {"limits", limits},
          {"causes", report.causes},
          {"why", report.why},
          {"cures", cures},
          {"critical_step", report.critical_step},
          {"estimated_step", report.estimated_step},
          {"step_of_squares", report.step_of_squares}};
}

Json topology_json(const Topology& t) {
  return {{"euler_characteristic", t.euler_characteristic},
          {"watertight", t.watertight()},
          {"free_edges", t.free_edges},
          {"branching_edges", t.branching_edges},
          {"disagreeing_edges", t.disagreeing_edges}};
}

Json distances_json(const Distances& d) {
  return {{"samples", d.samples},
          {"max", d.max},
          {"mean", d.mean},
          {"rms", std::sqrt(d.mean_square)},
          {"max_in_sizes", d.max_in_sizes}};
}

Json maps_json(const Prepared& p) {
  const MapReport maps = p.maps();
  const std::vector<Entity>& faces = p->boundary.regions;
  Json json = {{"patches", maps.patches.size()},
               {"sigma_mean", maps.sigma_mean},
               {"sigma_95", maps.sigma_95},
               {"sigma_max", maps.sigma_max},
               {"area_ratio", maps.area_ratio},
               {"worst_face", maps.worst_face < 0 ? Json() : Json(faces[maps.worst_face].tag)},
               {"by_patch", Json::array()}};
  for (const auto& [face, method, q] : maps.patches) {
    json["by_patch"].push_back({{"face", faces[face].tag},
                                {"method", method},
                                {"sigma_mean", q.sigma_mean},
                                {"sigma_95", q.sigma_95},
                                {"sigma_max", q.sigma_max},
                                {"area_ratio", q.area_ratio}});
  }
  return json;
}

Json share_json(const QuadShare& share) {
  return {{"quads", share.quads}, {"vertices", share.vertices}, {"eta_mean", share.eta}, {"d4", share.d4}};
}

Json surface_json(const Prepared& p, const SurfaceReport& report) {
  Json cuts = Json::array();
  for (const SurfaceCut& cut : p.cuts())
    cuts.push_back({{"curve", p->boundary.curves[cut.curve].tag},
                    {"face", p->boundary.regions[cut.face].tag},
                    {"length", cut.length},
                    {"divides", cut.divides}});
  return {{"maps", maps_json(p)},
          {"cuts", cuts},
          {"near_cuts", share_json(report.near_cuts)},
          {"off_cuts", share_json(report.off_cuts)},
          {"topology", topology_json(report.mesh)},
          {"model_topology", topology_json(report.model)},
          {"nonconforming_edges", report.nonconforming_edges.count},
          {"turned_elements", report.turned_elements.count},
          {"distances_in_diagonals",
           {{"mesh_to_surface", distances_json(report.mesh_to_surface)},
            {"surface_to_mesh", distances_json(report.surface_to_mesh)},
            {"nodes_in_faces", distances_json(report.nodes_in_faces)},
            {"nodes_on_curves", distances_json(report.nodes_on_curves)},
            {"nodes_at_corners", distances_json(report.nodes_at_corners)}}}};
}

Json failures_json(const MeshResult& result) {
  const Preparation& p = *result.prepared;
  Json json = Json::array();
  for (const FaceFailure& failure : result.failures)
    json.push_back({{"face", failure.face < 0 ? Json() : Json(p.boundary.regions[failure.face].tag)},
                    {"reason", failure.reason}});
  return json;
}

Json versions_json() {
  Json json = Json::object();
  for (const auto& [name, version] : versions()) json[name] = version;
  return json;
}

/// `start`: null outside of experiments.
void add_origin(Json& json, const MachineState* start = nullptr) {
  const Machine machine = this_machine();
  json["versions"] = versions_json();
  json["machine"] = {{"system", machine.system},
                     {"architecture", machine.architecture},
                     {"cpu", machine.processor},
                     {"processors", machine.processors}};
  if (start == nullptr) return;
  json["machine"]["load_average"] = start->load ? Json(*start->load) : Json();
  json["started"] = start->time;
}

/// The file of the model, or the name of the example.
std::string source_of(const Case& c) {
  if (const PlanarModel* model = planar_model(c)) return model->source;
  if (const std::string example = example_of(c); !example.empty()) return "example " + example;
  return model_path(c).string();
}

Json peer_json(const CellIdentity& cell) {
  Json json = record_of(*cell.peer);
  json["version_line"] = cell.peer_version;
  json["content"] = cell.peer_files;
  return json;
}

Json files_json(const CellIdentity& cell) {
  Json json = Json::object();
  for (const auto& [name, mark] : cell.files) json[name] = {{"bytes", mark.bytes}, {"digest", mark.digest}};
  return json;
}

/// A measure failed which another try might give: of a mesh that a solver refuses there is none, ever.
bool may_differ_again(const MeshMetrics& metrics) {
  return std::ranges::any_of(metrics.failures, [](const auto& failure) {
    return std::ranges::find(solver_names(), failure.first) == solver_names().end();
  });
}

/// `metrics`: "failed" where one of them has no value.
Json start_record(const Case& c, const Pipeline& pipeline, const std::string& status,
                  const CellIdentity* cell, const std::string& metrics = "ok") {
  Json json = Json::object();
  const auto mesh = cell != nullptr ? cell->files.find("mesh.msh") : decltype(cell->files.end()){};
  const bool has_mesh = cell != nullptr && mesh != cell->files.end();
  json["record"] = kRecordVersion;
  if (cell != nullptr) json["key"] = cell->key;
  if (cell != nullptr && metrics != "ok") json["metrics_status"] = metrics;
  json["case"] = c.name;
  json["pipeline"] = pipeline.text;
  json["status"] = status;
  json["quads_only"] = pipeline.quads_only();
  json["model"] = source_of(c);
  json["seed"] = c.seed;
  json["variant"] = Json::object();
  for (const auto& [title, value] : c.variant) json["variant"][title] = value;
  if (cell == nullptr) return json;
  if (cell->peer != nullptr) json["peer"] = peer_json(*cell);
  if (cell->peer != nullptr) json["peer_file"] = cell->peer_file;
  json["solvers"] = cell->solvers;
  json["experiment"] = cell->experiment;
  json["digests"] = {{"model", cell->model_digest}, {"program", cell->program_digest}};
  if (has_mesh) json["digests"]["mesh"] = mesh->second.digest;
  json["files"] = files_json(*cell);
  return json;
}

void add_problem(Json& json, const Case& c) {
  const ProblemRecord problem = record_of(c);
  json["problem"] = problem.json;
  if (!problem.in_memory.empty()) json["not_repeatable"] = problem.in_memory;
}

/// A file name or what a peer prints need not be UTF-8; JSON must be.
constexpr auto kReplace = Json::error_handler_t::replace;

std::string print(const Json& json) { return json.dump(2, ' ', false, kReplace) + "\n"; }

}  // namespace

std::string run_record(const Case& c, const Pipeline& pipeline, const MeshResult& result,
                       const CellIdentity* cell) {
  Json json = start_record(c, pipeline, "ok", cell, may_differ_again(result.metrics) ? "failed" : "ok");
  if (const Json own = added_metrics_json(result.metrics, cell); !own.empty()) json["own_metrics"] = own;
  json["sound"] = result.soundness.accepted();
  if (!result.soundness.accepted()) json["unsound"] = result.soundness.reasons;
  for (const std::string& beyond : result.soundness.beyond) json["unsound"].push_back(beyond);
  add_problem(json, c);
  json["domain"] = domain_json(result.prepared);
  json["cross_field"] = cross_json(result.prepared);
  json["warnings"] = texts(result.warnings);
  if (result.surface) json["surface"] = surface_json(result.prepared, *result.surface);
  if (!result.failures.empty()) json["left_out"] = failures_json(result);
  if (result.criteria) json["criteria"] = report_json(*result.criteria, result.mesh);
  const StageLog& log = result.log;
  json["bad_quads"] = bad_quads_json(result);
  const bool is_peer = cell != nullptr && cell->peer != nullptr;
  json["threads"] = thread_count();
  add_times(json, log.times);
  // A peer's time has reading and writing in it: not to be set beside this.
  json["meshing_seconds"] = is_peer ? Json() : Json(result.seconds);
  if (is_peer) json["peer_seconds"] = result.seconds;
  json["peak_memory_bytes"] = result.peak_memory;
  add_metrics(json, result.metrics);
  add_origin(json, cell != nullptr ? &cell->start : nullptr);
  add_summaries(json, log.summaries);
  return cell != nullptr ? sealed(print(json)) : print(json);
}

std::string failure_record(const Case& c, const Pipeline& pipeline, const std::string& status,
                           const std::string& kind, const std::string& reason, const CellIdentity* cell) {
  Json json = start_record(c, pipeline, status, cell);
  json["kind"] = kind;
  json["reason"] = reason;
  add_problem(json, c);
  add_origin(json, cell != nullptr ? &cell->start : nullptr);
  return cell != nullptr ? sealed(print(json)) : print(json);
}

std::string peer_record(const CellIdentity& cell) { return peer_json(cell).dump(-1, ' ', false, kReplace); }
std::string metrics_by_command_record(const CellIdentity& cell) {
  Json json = Json::array();
  for (const auto& metric : cell.metrics) json.push_back(metric_json(metric));
  for (const std::string& solver : cell.solvers) json.push_back("solver " + solver);
  return json.empty() ? "" : json.dump(-1, ' ', false, kReplace);
}
std::string versions_record() { return versions_json().dump(); }

std::string metrics_record(const std::string& mesh_file, const Mesh& mesh, const std::string& size,
                           const MeshMetrics& metrics, const CriteriaReport* criteria) {
  Json json = {{"mesh", mesh_file}, {"size", size.empty() ? Json() : Json(size)}};
  if (criteria != nullptr) json["criteria"] = report_json(*criteria, mesh);
  add_metrics(json, metrics);
  add_origin(json);
  return print(json);
}

}  // namespace delquad
