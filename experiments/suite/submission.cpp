#include "experiments/suite/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ostream>
#include <set>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/console/progress.h"
#include "experiments/suite/suite_list.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/machine.h"
#include "experiments/sweep/peer.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "io/cases/toml_reader.h"
#include "io/digest.h"
#include "io/library_file.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/shape.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/tables.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;

constexpr const char *kModelsFolder = "models", *kDescription = "result.toml";

/// The mesh of a case; empty: there is none.
fs::path find_mesh(const fs::path& folder, const std::string& name) {
  const fs::path msh = folder / (name + ".msh"), obj = folder / (name + ".obj");
  if (fs::exists(msh) && fs::exists(obj))
    refuse("{} and {}: expected one of them", msh.string(), obj.filename().string());
  return fs::exists(msh) ? msh : fs::exists(obj) ? obj : fs::path();
}

/// As a peer's mesh is measured.
MeshResult measure(const Prepared& prepared, const fs::path& file) {
  Mesh mesh = read_mesh(file);
  require_straight(mesh, file.string());
  check_is_of_model(prepared, mesh);
  MeshResult result = prepared.measure(std::move(mesh));
  result.warnings = prepared->warnings;
  return result;
}

/// The cells of one submission.
class Adding {
 public:
  Adding(const Submission& submission, const std::vector<SuiteModel>& models, Experiment& experiment,
         const fs::path& results)
      : submission_(submission), experiment_(experiment), folder_(results / submission.program) {
    for (const SuiteModel& model : models)
      for (std::size_t k = 0; k < model.sizes.size(); ++k) asked_.insert(case_name(model, k));
    peer_.name = submission.program;
    peer_.command = {submission.command};
    peer_.folder = submission.folder;
    peer_.file = submission.folder / kDescription;
    experiment.words = {Word{submission.program, {}}};
    experiment.peers = {peer_};
  }

  SubmissionCount run() {
    prepare_folder(folder_);
    const FolderLock lock(folder_, 0, 1);
    for (const fs::path& record : record_files(folder_)) remove_cell(record.parent_path());
    for (const std::string& file : result_files()) fs::remove_all(folder_ / file);
    write_study(folder_, describe(experiment_));
    write_file_atomically(folder_ / kDescription, [&](std::ostream& out) { copy_into(out, peer_.file); });
    Progress progress(static_cast<int>(experiment_.n_cases()));
    for (std::size_t i = 0; i < experiment_.n_cases(); ++i) {
      const Case c = experiment_.read_variant(i);
      known_.insert(c.name);
      progress.step(c.name);
      if (asked_.contains(c.name)) add(c);
    }
    for (const std::string& error : write_tables(folder_, make_tables(folder_))) throw InputError(error);
    for (const auto& entry : fs::directory_iterator(submission_.folder)) {
      const fs::path file = entry.path().filename();
      if ((file.extension() == ".msh" || file.extension() == ".obj") && !known_.contains(file.stem()))
        count_.of_no_case.push_back(file.string());
    }
    std::ranges::sort(count_.of_no_case);
    return count_;
  }

 private:
  void add(const Case& c) {
    const fs::path file = find_mesh(submission_.folder, c.name);
    CellIdentity identity;
    identity.model_digest = model_digest(c);
    identity.start = machine_state();
    identity.peer = &peer_;
    identity.peer_version = submission_.version;
    identity.key = digest(identity.model_digest + (file.empty() ? "" : file_digest(file)));
    if (file.empty()) {
      ++count_.missing;
      return refuse(c, identity, "missing", fmt::format("there is no {0}.msh and no {0}.obj", c.name));
    }
    try {
      write(c, identity, file);
      ++count_.measured;
    } catch (const Error& error) {
      ++count_.refused;
      refuse(c, identity, "bad input", fmt::format("{}: {}", file.filename().string(), error.what()));
    }
  }

  void write(const Case& c, CellIdentity& identity, const fs::path& file) {
    const MeshResult result = measure(prepare(c), file);
    const Word& word = experiment_.words[0];
    write_cell(cell_folder(folder_, c, word), [&](const fs::path& at) {
      write_mesh(at / "mesh.msh", result.mesh);
      identity.files = marks_of(at);
      write_text_file(at / "record.json", run_record(c, word, result, &identity));
    });
  }

  void refuse(const Case& c, const CellIdentity& identity, const char* kind, const std::string& reason) {
    const Word& word = experiment_.words[0];
    write_cell(cell_folder(folder_, c, word), [&](const fs::path& at) {
      write_text_file(at / "record.json", failure_record(c, word, "failed", kind, reason, &identity));
    });
  }

  const Submission& submission_;
  Experiment& experiment_;
  const fs::path folder_;
  std::set<std::string> asked_, known_;  // cases
  Peer peer_;
  SubmissionCount count_;
};

/// Small letters, digits, - and _, a letter first.
bool is_name(const std::string& text) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && is_letter(text[0]) && std::ranges::all_of(text, [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

/// As for our own meshes, see docs/results.md.
constexpr double kFurthest = 1.25;  // sizes

/// What is compared: triangles in space, or of planar meshes the lines of the boundary, as flat triangles;
/// with places on them.
struct Shape {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec3> places;
};

void add_line(Shape& shape, int a, int b) {
  shape.triangles.push_back({a, b, b});
  shape.places.push_back(shape.points[a]);
  shape.places.push_back(0.5 * (shape.points[a] + shape.points[b]));
}

Shape lines_of(const Mesh& lines) {
  Shape shape{lines.points, {}, {}};
  for (const auto& [a, b] : lines.lines) add_line(shape, a, b);
  return shape;
}

Shape outline_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) add_line(shape, edge[0].lo, edge[0].hi);
  });
  return shape;
}

Shape surface_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
  for_each_element(mesh, [&](int, const auto& v) {
    Vec3 sum;
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (k >= 2) shape.triangles.push_back({v[0], v[k - 1], v[k]});
      sum = sum + mesh.points[v[k]];
      shape.places.push_back(mesh.points[v[k]]);
    }
    shape.places.push_back(1.0 / static_cast<double>(v.size()) * sum);
  });
  return shape;
}

/// Throws PeerError where a place of one shape is too far from the other.
void check_near(const Shape& from, const Shape& to, const SizeField& size, const char* what) {
  const NearestTriangle nearest(to.points, to.triangles);
  int guess = -1, hint = -1;
  for (const Vec3& p : from.places) {
    const auto found = nearest.find_from(guess, p);
    guess = found.triangle;
    const double sizes = found.distance / size.at(p, hint);
    if (!(sizes <= kFurthest))
      refuse<PeerError>("it is no mesh of this model: {} at {}, {:.3g} sizes", what, show_point(p), sizes);
  }
}

/// The boundary's lines that bound one region (outer) or two (interfaces).
Mesh lines_at(const Prepared& prepared, int n_regions) {
  const auto edge = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
  std::map<std::array<int, 2>, int> regions;
  for (std::size_t p = 0; p < prepared.n_patches(); ++p)
    for (const auto& [i, j] : prepared.patch(p).edges)
      ++regions[edge(prepared.patch(p).point_node[i], prepared.patch(p).point_node[j])];
  Mesh lines = boundary_of(prepared);
  std::erase_if(lines.lines, [&](const auto& line) { return regions[edge(line[0], line[1])] != n_regions; });
  return lines;
}

Shape edges_of(const Mesh& mesh) {
  Shape shape{mesh.points, {}, {}};
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides),
                [&](std::span<const HalfEdge> edge) { add_line(shape, edge[0].lo, edge[0].hi); });
  return shape;
}

/// That the case asks for; of a metric the longest length at each place.
std::shared_ptr<const SizeField> size_of(const Prepared& prepared) {
  const auto metric = followed_metric(prepared);
  if (!metric) return prepared->size.field;
  std::vector<double> longest;
  for (const Tensor2& m : metric->at) longest.push_back(axes_of(m).h2);
  return make_nodal_size(metric->mesh, std::move(longest));
}

/// Edges follow the curves between regions: places there are much nearer to edges, on average, than the sixth
/// of a size that they are in a grid which does not know of them.
void check_interfaces(const Prepared& prepared, const SizeField& size, const Mesh& mesh) {
  constexpr double kMean = 0.08;  // sizes
  const Shape interfaces = lines_of(lines_at(prepared, 2)), edges = edges_of(mesh);
  if (interfaces.places.empty()) return;
  const NearestTriangle nearest(edges.points, edges.triangles);
  double sum = 0;
  int guess = -1, hint = -1;
  for (const Vec3& p : interfaces.places) {
    const auto found = nearest.find_from(guess, p);
    guess = found.triangle;
    sum += found.distance / size.at(p, hint);
  }
  const double mean = sum / static_cast<double>(interfaces.places.size());
  if (mean > kMean)
    refuse<PeerError>(
        "its edges do not follow the curves between regions, which are {:.2g} sizes off "
        "on average",
        mean);
}

}  // namespace

Submission read_submission(const fs::path& folder) {
  const TomlTable table = TomlTable::read(folder / kDescription);
  Submission submission{folder, table.text("program"), table.text("version"), table.text("command"),
                        table.texts("authors")};
  table.finish();
  if (!is_name(submission.program) || submission.program == kModelsFolder)
    refuse("{}: program '{}': expected small letters, digits, - and _, such as 'mesher-2'",
           table.where("program"), submission.program);
  if (submission.authors.empty()) throw InputError(table.where("authors") + ": expected at least one");
  return submission;
}

SubmissionCount add_submission(const Submission& submission, const fs::path& results,
                               const std::vector<SuiteModel>& models, const std::vector<SuiteModel>& all) {
  const auto has_mesh = [&](const SuiteModel& model) {
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      if (!find_mesh(submission.folder, case_name(model, k)).empty()) return true;
    return false;
  };
  if (std::ranges::none_of(models, has_mesh))
    refuse("{}: no mesh of any case: expected {}.msh or .obj and so on", submission.folder.string(),
           case_name(models[0], 0));
  const fs::path folder = results / submission.program;
  if (read_study(folder) && !fs::exists(folder / kDescription))
    throw InputError(folder.string() + ": holds the results of a run: call the program otherwise");
  Experiment experiment = write_suite_experiment(results / kModelsFolder, all);
  return Adding(submission, models, experiment, results).run();
}

void check_is_of_model(const Prepared& prepared, Mesh& mesh) {
  Peer peer;
  peer.keeps_boundary = false;
  check_peer_mesh(peer, prepared, mesh);
  const bool planar = !prepared.is_surface();
  const Shape model = planar ? lines_of(lines_at(prepared, 1)) : surface_of(prepared.fine());
  const Shape made = planar ? outline_of(mesh) : surface_of(mesh);
  const auto size = size_of(prepared);
  check_near(made, model, *size, "it lies off the model");
  check_near(model, made, *size, "the model is not covered");
  if (planar) check_interfaces(prepared, *size, mesh);
}

namespace {

namespace fs = std::filesystem;

/// In place of a family.
constexpr const char* kAll = "all";
/// The column of the programs that one is proven to be better than.
constexpr const char* kBetterThan = "better_than";

/// What a program made of the cases, by their names.
struct Program {
  std::string name;
  std::map<std::string, CellRecord> records;
};

std::vector<fs::path> result_folders(const fs::path& results) {
  std::vector<fs::path> folders;
  if (fs::exists(results / "study.json")) folders.push_back(results);
  if (fs::is_directory(results))
    for (const auto& entry : fs::directory_iterator(results))
      if (fs::exists(entry.path() / "study.json")) folders.push_back(entry.path());
  std::ranges::sort(folders);
  if (folders.empty())
    throw InputError(results.string() +
                     ": no results of the suite: expected folders of 'delquad run' or 'delquad suite add'");
  return folders;
}

bool is_not_applicable(const CellRecord& record) { return record.kind == kNotApplicable; }

std::vector<Program> read_programs(const fs::path& results) {
  std::vector<Program> programs;
  for (const fs::path& folder : result_folders(results)) {
    StudyResults found = read_results(folder);
    if (found.study.title != suite_title())
      refuse("{}: holds results of '{}', not of '{}'", folder.string(), found.study.title, suite_title());
    for (const std::string& name : found.study.pipelines) {
      const bool known = std::ranges::find(programs, name, &Program::name) != programs.end();
      programs.push_back({known ? folder.filename().string() + "/" + name : name, {}});
      for (CellRecord& record : found.records)
        if (record.pipeline == name) programs.back().records[record.name] = std::move(record);
    }
  }
  return programs;
}

bool is_sound(const CellRecord& record) {
  return record.reason.empty() && !record.skipped && record.unsound.empty();
}

/// Of a mesh, where the case has a metric in that.
double measure_of(const CellRecord& record, SuiteFamily family, const std::string& key) {
  return value_of(record, (family == SuiteFamily::kMetric && key != "d4" ? "metric_" : "") + key);
}

/// NaN: it was not run.
double score_of(const CellRecord* record, SuiteFamily family) {
  if (record == nullptr || record->skipped) return std::nan("");
  const double quads = is_sound(*record) ? value_of(*record, "percent_quads") : 0;
  // Without any quad there is no eta.
  return quads > 0
             ? measure_of(*record, family, "eta_mean") * measure_of(*record, family, "tau") * quads / 100
             : 0;
}

/// `group`: a family; null: all of those that every program can be asked.
bool is_in(const SuiteModel& model, const SuiteFamily* group) {
  return group != nullptr ? model.family == *group : is_for_all(model.family);
}

const CellRecord* find_record(const Program& program, const std::string& name) {
  const auto at = program.records.find(name);
  return at == program.records.end() ? nullptr : &at->second;
}

/// By their names, those of a group that were run: the means over their cases.
using ModelScores = std::map<std::string, double>;
ModelScores score_models(const Program& program, const SuiteFamily* family) {
  ModelScores scores;
  for (const SuiteModel& model : suite().models) {
    std::vector<double> run;
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      if (const double score = score_of(find_record(program, case_name(model, k)), model.family);
          !std::isnan(score))
        run.push_back(score);
    if (!run.empty() && is_in(model, family)) scores[model.name] = mean(run);
  }
  return scores;
}

/// What is added up over the cases of a family.
class Sums {
 public:
  void add_case(const CellRecord* record, SuiteFamily family) {
    if (record == nullptr || record->skipped) return;
    ++cases_;
    if (!is_sound(*record)) return;
    ++sound_;
    solved_ += value_of(*record, "percent_quads") == 100;
    for (const char* key : {"eta_mean", "d4", "tau"})
      if (const double value = measure_of(*record, family, key); !std::isnan(value))
        values_[key].push_back(value);
    worst_ = std::min(worst_, measure_of(*record, family, "eta_worst"));
    if (const double time = value_of(*record, "seconds_total"); time > 0) seconds_ += time;
  }

  std::map<std::string, double> values() const {
    std::map<std::string, double> values = {{"cases", cases_},
                                            {"solved", solved_},
                                            {"with_triangles", sound_ - solved_},
                                            {"failed", cases_ - sound_}};
    if (sound_ == 0) return values;
    values["eta_worst"] = worst_;
    for (const auto& [key, list] : values_) values[key] = mean(list);
    if (seconds_ > 0) values["seconds_total"] = seconds_;
    return values;
  }

 private:
  int cases_ = 0, sound_ = 0, solved_ = 0;
  double worst_ = 1, seconds_ = 0;
  std::map<std::string, std::vector<double>> values_;
};

/// A program in a group (all models, or a family).
struct Entry {
  TableRow row;
  ModelScores scores;
};

Entry entry_of(const Program& program, const SuiteFamily* family) {
  Sums sums;
  for (const SuiteModel& model : suite().models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      if (is_in(model, family)) sums.add_case(find_record(program, case_name(model, k)), model.family);
  Entry entry{{}, score_models(program, family)};
  entry.row.group = family != nullptr ? name_of(*family) : kAll;
  entry.row.name = program.name;
  entry.row.values = sums.values();
  std::vector<double> scores;
  for (const auto& [model, score] : entry.scores) scores.push_back(score);
  entry.row.values["models"] = static_cast<double>(scores.size());
  if (scores.empty()) return entry;
  entry.row.values["score"] = mean(scores);
  entry.row.half_widths["score"] = confidence_half_width(scores);
  return entry;
}

/// The best first, those that ran fewer cases below the others.
std::vector<Entry> rank(const std::vector<Program>& programs, const SuiteFamily* family) {
  std::vector<Entry> entries;
  for (const Program& program : programs) entries.push_back(entry_of(program, family));
  std::erase_if(entries, [](const Entry& entry) { return entry.scores.empty(); });
  std::ranges::stable_sort(entries, std::greater(), [](const Entry& entry) {
    return std::pair(entry.row.values.at("cases"), entry.row.values.at("score"));
  });
  return entries;
}

/// First minus second, on the models that both ran.
std::vector<double> differences(const Entry& first, const Entry& second) {
  std::vector<double> differences;
  for (const auto& [model, score] : first.scores)
    if (const auto at = second.scores.find(model); at != second.scores.end())
      differences.push_back(score - at->second);
  return differences;
}

/// Writes to each which programs it is proven to be better than: a family of tests over every two of every
/// group. Returns a note on them.
std::string test_groups(std::vector<std::vector<Entry>>& groups) {
  struct Duel {
    Entry *first, *second;
    double effect;
    std::size_t test;
  };
  ClaimFamily family;
  std::vector<Duel> duels;
  for (std::vector<Entry>& group : groups)
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = i + 1; j < group.size(); ++j)
        if (const auto d = differences(group[i], group[j]); !d.empty())
          duels.push_back({&group[i], &group[j], mean(d), family.add(wilcoxon(d))});
  family.decide();
  for (const Duel& duel : duels) {
    if (family.finding(duel.test) != Finding::kProven || duel.effect * family.test(duel.test).lean <= 0)
      continue;
    std::string& beaten = (duel.effect > 0 ? duel.first : duel.second)->row.texts[kBetterThan];
    beaten += (beaten.empty() ? "" : ", ") + (duel.effect > 0 ? duel.second : duel.first)->row.name;
  }
  return "better than: is proven by Wilcoxon's signed-rank test over the models that both ran. " +
         family.note();
}

/// The record by which a program has nothing to rank in a group, as all that it was asked there is not
/// applicable; null: it has.
const CellRecord* find_absence(const Program& program, const SuiteFamily* group) {
  const CellRecord* absence = nullptr;
  for (const SuiteModel& model : suite().models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k) {
      const CellRecord* record = is_in(model, group) ? find_record(program, case_name(model, k)) : nullptr;
      if (record == nullptr) continue;
      if (!is_not_applicable(*record)) return nullptr;
      absence = record;
    }
  return absence;
}

/// Rows below those that are ranked, and notes with the reasons; families are named only where the program is
/// ranked in others.
void add_absent(const std::vector<Program>& programs, const SuiteFamily* group, Table& table) {
  for (const Program& program : programs) {
    const CellRecord* absence = find_absence(program, group);
    if (absence == nullptr || (group != nullptr && find_absence(program, nullptr) != nullptr)) continue;
    TableRow row;
    row.group = group != nullptr ? name_of(*group) : kAll;
    row.name = program.name;
    row.skipped = kNotApplicable;
    table.rows.push_back(std::move(row));
    table.notes.push_back(fmt::format("{} is not applicable{}: {}", program.name,
                                      group != nullptr ? fmt::format(" to {}", name_of(*group)) : "",
                                      absence->reason));
  }
}

}  // namespace

Table rank_programs(const fs::path& results) {
  const std::vector<Program> programs = read_programs(results);
  Table table;
  table.title = suite_title() + ", ranked";
  table.group_title = "family";
  table.name_title = "program";
  table.columns = {{"score", "score", 1},
                   {"models", "models", 0},
                   {"cases", "cases", 0},
                   {"solved", "solved", 0},
                   {"with_triangles", "with triangles", 0},
                   {"failed", "failed", 0},
                   {"eta_worst", "eta worst", 3},
                   {"eta_mean", "eta mean", 3},
                   {"d4", "d4", 1},
                   {"tau", "tau", 1},
                   {"seconds_total", "CPU s", 1},
                   {kBetterThan, "better than", 0}};
  table.notes = {
      "score: mean over the models of mean eta x tau x share of quads, averaged over a model's cases; 0 for "
      "a "
      "case without a sound mesh; in percent",
      "cases: that were run; who ran fewer stands below. Solved: sound and quads only; failed: no mesh, or "
      "one "
      "that is not sound or not of its model",
      "eta worst: the least; eta mean, d4, tau: means over the sound meshes; CPU s: their sum, where known",
      "all: planar, CAD, triangles and hard; metric (eta and tau in the metric) and public stand by "
      "themselves"};
  std::vector<const SuiteFamily*> families = {nullptr};
  for (const SuiteFamily& family : kSuiteFamilies) families.push_back(&family);
  std::vector<std::vector<Entry>> groups;
  for (const SuiteFamily* family : families) groups.push_back(rank(programs, family));
  table.notes.push_back(test_groups(groups));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const Entry& entry : groups[g]) table.rows.push_back(entry.row);
    add_absent(programs, families[g], table);
  }
  return table;
}

void write_ranking(const fs::path& results, const Table& table) {
  prepare_folder(results / "ranking");
  for (const TableFormat& format : table_formats())
    write_text_file(results / "ranking" / ("table" + std::string(format.extension)), format.print(table));
}

}  // namespace delquad
