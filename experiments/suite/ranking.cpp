#include "experiments/suite/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ostream>

#include "delquad/error.h"
#include "experiments/suite/suite_list.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/peer.h"
#include "io/mesh_io.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// In place of a family.
constexpr const char* kAll = "all";

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

/// Whether all of its cells are not applicable, as those of a peer that is absent here: there is nothing to
/// rank.
bool is_absent(const Program& program) {
  return !program.records.empty() && std::ranges::all_of(program.records, [](const auto& record) {
    return record.second.kind == kNotApplicable;
  });
}

std::vector<Program> read_programs(const fs::path& results) {
  std::vector<Program> programs;
  for (const fs::path& folder : result_folders(results)) {
    StudyResults found = read_results(folder);
    if (found.study.title != suite_title())
      throw InputError(fmt::format("{}: holds results of '{}', not of '{}'", folder.string(),
                                   found.study.title, suite_title()));
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

/// What is added up over the cases of a family.
class Sums {
 public:
  void add_case(const CellRecord* record) {
    ++cases_;
    if (record == nullptr) ++not_run_;
    if (record == nullptr || !is_sound(*record)) return;
    ++sound_;
    const double quads = value_of(*record, "percent_quads");
    solved_ += quads == 100;
    // Without any quad there is no eta.
    if (quads > 0) score_ += value_of(*record, "eta_mean") * value_of(*record, "tau") / 100 * quads / 100;
    for (const char* key : {"eta_mean", "d4", "tau"})
      if (const double value = value_of(*record, key); !std::isnan(value)) values_[key].push_back(value);
    worst_ = std::min(worst_, value_of(*record, "eta_worst"));
    if (const double time = value_of(*record, "seconds_total"); time > 0) seconds_ += time;
  }

  std::map<std::string, double> values() const {
    std::map<std::string, double> values = {{"score", 100 * score_ / cases_},
                                            {"cases", cases_},
                                            {"solved", solved_},
                                            {"with_triangles", sound_ - solved_},
                                            {"failed", cases_ - sound_ - not_run_},
                                            {"not_run", not_run_}};
    if (sound_ == 0) return values;
    values["eta_worst"] = worst_;
    for (const auto& [key, list] : values_) values[key] = mean(list);
    if (seconds_ > 0) values["seconds_total"] = seconds_;
    return values;
  }

 private:
  int cases_ = 0, sound_ = 0, solved_ = 0, not_run_ = 0;
  double score_ = 0, worst_ = 1, seconds_ = 0;
  std::map<std::string, std::vector<double>> values_;
};

/// `family`: null: all of them.
TableRow row_of(const Program& program, const SuiteFamily* family) {
  Sums sums;
  for (const SuiteModel& model : suite().models) {
    if (family != nullptr && model.family != *family) continue;
    for (std::size_t k = 0; k < model.sizes.size(); ++k) {
      const auto at = program.records.find(case_name(model, k));
      sums.add_case(at == program.records.end() ? nullptr : &at->second);
    }
  }
  TableRow row;
  row.group = family != nullptr ? name_of(*family) : kAll;
  row.name = program.name;
  row.values = sums.values();
  return row;
}

void add_rows(const std::vector<Program>& programs, const SuiteFamily* family, Table& table) {
  std::vector<TableRow> rows;
  for (const Program& program : programs) rows.push_back(row_of(program, family));
  std::ranges::stable_sort(rows, std::greater(), [](const TableRow& row) { return row.values.at("score"); });
  table.rows.insert(table.rows.end(), rows.begin(), rows.end());
}

/// A row below those that are ranked, and a note with the reason.
void add_absent(const Program& program, Table& table) {
  TableRow row;
  row.group = kAll;
  row.name = program.name;
  row.skipped = kNotApplicable;
  table.rows.push_back(std::move(row));
  table.notes.push_back(
      fmt::format("{} is not applicable: {}", program.name, program.records.begin()->second.reason));
}

}  // namespace

Table rank_programs(const fs::path& results) {
  std::vector<Program> programs = read_programs(results);
  const auto absent = std::ranges::stable_partition(programs, std::not_fn(is_absent));
  const std::vector<Program> not_ranked(absent.begin(), absent.end());
  programs.erase(absent.begin(), absent.end());
  Table table;
  table.title = suite_title() + ", ranked";
  table.group_title = "family";
  table.name_title = "program";
  table.columns = {{"score", "score", 2},
                   {"cases", "cases", 0},
                   {"solved", "solved", 0},
                   {"with_triangles", "with triangles", 0},
                   {"failed", "failed", 0},
                   {"not_run", "not run", 0},
                   {"eta_worst", "eta worst", 3},
                   {"eta_mean", "eta mean", 3},
                   {"d4", "d4", 1},
                   {"tau", "tau", 1},
                   {"seconds_total", "CPU s", 1}};
  add_rows(programs, nullptr, table);
  for (const Program& program : not_ranked) add_absent(program, table);
  for (const SuiteFamily family : {SuiteFamily::kPlanar, SuiteFamily::kCad, SuiteFamily::kTriangles})
    add_rows(programs, &family, table);
  const std::vector<std::string> legend = {
      "score: mean over all cases of mean eta x tau x share of quads, 0 for a case without a sound mesh, in "
      "percent",
      "solved: sound and quads only; failed: no mesh, or one that is not sound or not of its model; not run: "
      "without a result, which counts as 0, too",
      "eta worst: the least; eta mean, d4, tau: means over the sound meshes; CPU s: their sum, where known"};
  table.notes.insert(table.notes.begin(), legend.begin(), legend.end());
  return table;
}

void write_ranking(const fs::path& results, const Table& table) {
  prepare_folder(results / "ranking");
  for (const TableFormat& format : table_formats())
    write_text_file(results / "ranking" / ("table" + std::string(format.extension)), format.print(table));
}

}  // namespace delquad
