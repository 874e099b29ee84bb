// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/located.h"
#include "base/system.h"
#include "delquad/error.h"
#include "experiments/sweep/verify.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Elements of `more` that `list` lacks go to its end.
template <class T>
void unite(std::vector<T>& list, const std::vector<T>& more) {
  for (const T& one : more)
    if (std::ranges::find(list, one) == list.end()) list.push_back(one);
}

std::vector<std::string> titles(const StudyFile& study) {
  std::vector<std::string> all;
  for (const auto& [title, values] : study.axes) all.push_back(title);
  return all;
}

void add_study(const StudyFile& other, const fs::path& folder, StudyFile& study) {
  if (other.experiment != study.experiment)
    refuse("{}: holds results of the experiment '{}', not of '{}'", folder.string(), other.experiment,
           study.experiment);
  if (titles(other) != titles(study))
    refuse("{}: its [matrix] varies {}, not {}", folder.string(), Json(titles(other)).dump(),
           Json(titles(study)).dump());
  study.plan_changed |= other.plan_changed || !have_same_plan(other, study);
  for (const auto& [variant, digests] : other.problems) unite(study.problems[variant], digests);
  unite(study.cases, other.cases);
  study.geometry.insert(other.geometry.begin(), other.geometry.end());
  unite(study.pipelines, other.pipelines);
  for (std::size_t k = 0; k < study.axes.size(); ++k) unite(study.axes[k].second, other.axes[k].second);
  for (const PublishedRow& row : other.published)
    if (std::ranges::find(study.published, row.name, &PublishedRow::name) == study.published.end())
      study.published.push_back(row);
  for (const auto& [name, rows] : other.compare) study.compare[name].insert(rows.begin(), rows.end());
  unite(study.may_fail, other.may_fail);
  study.step_times |= other.step_times;
}

void count_cells(StudyFile& study) {
  study.cells = study.cases.size() * study.pipelines.size();
  for (const auto& [title, values] : study.axes) study.cells *= values.size();
}

/// Returns the digests of the model and the mesh.
std::array<std::string, 2> digests_of(const CellRecord& record) {
  std::ifstream in(record.folder / "record.json");
  try {
    const Json digests = Json::parse(in).at("digests");
    return {digests.at("model"), digests.at("mesh")};
  } catch (const Json::exception& error) {
    throw InputError(json_problem(record.folder / "record.json", "is no record of a cell", error));
  }
}

/// A cell of one of the folders.
struct Candidate {
  CellRecord record;
  std::vector<std::string> damage;
};

/// Whether one takes the place of the one before. Throws where both were done and are not the same.
bool is_better(const Candidate& one, const Candidate& before) {
  const CellRecord &other = one.record, &known = before.record;
  if (one.damage.empty() != before.damage.empty()) return one.damage.empty();
  if (other.reason.empty() != known.reason.empty()) return other.reason.empty();
  if (!one.damage.empty()) return false;
  if (other.reason.empty() && digests_of(other) != digests_of(known))
    refuse("the cell {} {} differs between {} and {}: its model or its mesh is another one", known.group,
           known.pipeline, known.folder.string(), other.folder.string());
  return false;
}

using CellsToUnite = std::map<std::pair<std::string, std::string>, Candidate>;

void add_cells(const StudyResults& results, CellsToUnite& cells) {
  for (const CellRecord& record : results.records) {
    const Candidate candidate{record, damage_of_cell(record.folder / "record.json", results.study)};
    const auto [at, is_new] = cells.try_emplace({record.group, record.pipeline}, candidate);
    if (!is_new && is_better(candidate, at->second)) at->second = candidate;
  }
}

/// A cell that no folder has sound is not handed on.
void check_sound(const CellsToUnite& cells) {
  std::vector<std::string> damage;
  for (const auto& [name, cell] : cells) unite(damage, cell.damage);
  if (!damage.empty())
    refuse("{}{}: remove the folder of the cell, and 'delquad run' makes it again", damage[0],
           damage.size() > 1 ? fmt::format(" (and {} more, by 'delquad verify')", damage.size() - 1) : "");
}

void copy_cell(const CellRecord& cell, const fs::path& output) {
  const fs::path variant = cell.folder.parent_path(), to = output / variant.filename();
  fs::create_directories(to);
  fs::copy(cell.folder, to / cell.folder.filename(), fs::copy_options::recursive);
}

void check_output(const std::vector<fs::path>& folders, const fs::path& output) {
  if (fs::exists(output)) throw InputError(output.string() + ": is there already: expected a new folder");
  for (const fs::path& folder : folders)
    if (*fs::weakly_canonical(fs::absolute(output)).lexically_relative(fs::canonical(folder)).begin() != "..")
      refuse("{}: lies inside of {}, which must not change: expected another folder", output.string(),
             folder.string());
}

void fill(const fs::path& target, const std::vector<fs::path>& folders, const StudyFile& study,
          const CellsToUnite& cells) {
  for (const fs::path& folder : folders)
    if (fs::exists(folder / "experiment"))
      fs::copy(folder / "experiment", target / "experiment",
               fs::copy_options::recursive | fs::copy_options::skip_existing);
  for (const auto& [name, cell] : cells) copy_cell(cell.record, target);
  write_study(target, study);
  for (const std::string& error : write_tables(target, make_tables(target))) throw InputError(error);
}

}  // namespace

void merge_results(const std::vector<fs::path>& folders, const fs::path& output) {
  std::vector<StudyResults> all;
  for (const fs::path& folder : folders) all.push_back(read_results(folder));
  check_output(folders, output);
  StudyFile study = all[0].study;
  CellsToUnite cells;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) add_study(all[i].study, folders[i], study);
    add_cells(all[i], cells);
  }
  check_sound(cells);
  count_cells(study);
  try {
    const TemporaryFolder scratch(fs::absolute(output).parent_path() / ("." + output.filename().string()));
    const fs::path target = scratch.path() / "results";
    fs::create_directory(target);
    fill(target, folders, study, cells);
    fs::rename(target, output);
  } catch (const fs::filesystem_error& error) {
    throw InputError(output.string() + ": cannot be written: " + error.code().message());
  }
}

}  // namespace delquad
