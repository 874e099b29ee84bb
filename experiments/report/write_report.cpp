// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/write_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <ostream>

#include "base/text.h"
#include "delquad/error.h"
#include "experiments/report/packed_mesh.h"
#include "experiments/report/page.h"
#include "experiments/report/page_json.h"
#include "io/mesh_io.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// A page holds drawings, values of cells and pictures of meshes up to this.
constexpr std::size_t kMostBytes = 50'000'000;
/// That are shown one by one; more would make a page that no browser likes. Tables have all.
constexpr std::size_t kMostCells = 2000;

struct Study {
  std::string name;  ///< of its folder
  StudyResults results;
  std::vector<fs::path> drawings;
};

struct Contents {
  std::vector<Study> studies;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< folder and reason
};

bool has_study(const fs::path& folder) { return fs::exists(folder / "study.json"); }

/// Returns the wanted entries of a folder, in the order of the names.
std::vector<fs::path> list(const fs::path& folder, const std::function<bool(const fs::path&)>& wanted) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (wanted(at->path())) found.push_back(at->path());
  if (error) throw InputError(folder.string() + ": " + cannot_be_read(error.message()));
  std::ranges::sort(found);
  return found;
}

/// Returns the SVG files in `figures/` of a folder of results, by name.
std::vector<fs::path> list_drawings(const fs::path& folder) {
  if (!fs::is_directory(folder / "figures")) return {};
  return list(folder / "figures",
              [](const fs::path& path) { return path.extension() == ".svg" && fs::is_regular_file(path); });
}

void add_results(const fs::path& folder, Contents& contents) {
  const std::string name = fs::absolute(folder).lexically_normal().filename().string();
  contents.studies.push_back({name, read_results(folder), list_drawings(folder)});
}

Contents read_contents(const fs::path& folder) {
  const std::vector<fs::path> inside = list(folder, has_study);
  Contents contents;
  if (has_study(folder) || inside.empty()) {
    add_results(folder, contents);
    return contents;
  }
  for (const fs::path& results : inside) try {
      add_results(results, contents);
    } catch (const InputError& reason) {
      contents.left_out.emplace_back(results.filename().string(), reason.what());
    }
  if (contents.studies.empty()) throw InputError(contents.left_out[0].second);
  return contents;
}

class Page {
 public:
  Page(const Contents& contents, std::ostream& out) : contents_(contents), out_(out) {}

  void write() {
    begin_page(out_, "Delquad: results", kPageStyle, kPageBody);
    Json json = glossary_json();
    json["studies"] = Json::array();
    for (const Study& study : contents_.studies) json["studies"].push_back(study_json(study));
    json["left_out"] = contents_.left_out;
    end_page(out_, std::move(json), in_space_, kReportScript);
  }

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  /// Whether there is room for so much, which then is used.
  bool take(std::size_t bytes) {
    if (used_ + bytes > kMostBytes) return false;
    used_ += bytes;
    return true;
  }

  Json study_json(const Study& study) {
    const Outcome outcome = make_tables(study.results);
    const Json tables = {table_json(outcome.table), table_json(outcome.pairs),
                         table_json(outcome.hypotheses)};
    Json json = {{"name", study.name},
                 {"title", study.results.study.title},
                 {"tables", tables},
                 {"growth", growth_json(study.results.records)},
                 {"samples", add_samples(study.results.records, outcome.table.columns)},
                 {"drawings", drawings_json(study.drawings)},
                 {"sheets", Json::array()}};
    json["cells_left_out"] = add_sheets(study, outcome.table.columns, json["sheets"]);
    return json;
  }

  /// Returns for each drawing its name and its text. If there is no room for it, returns its place under
  /// `left_out`.
  Json drawings_json(const std::vector<fs::path>& files) {
    Json json = Json::array();
    for (const fs::path& file : files) {
      json.push_back({{"name", file.stem().string()}});
      const bool fits = take(fs::file_size(file));
      json.back()[fits ? "svg" : "left_out"] = fits ? file_bytes(file) : file.string();
    }
    return json;
  }

  /// Where the values of the cells stand in the page; "left out" when there is no room for them.
  Json add_samples(const std::vector<CellRecord>& records, const std::vector<TableColumn>& columns) {
    const std::string text = packed_text(samples_json(records, columns).dump());
    if (!take(text.size())) return "left out";
    const std::string id = fmt::format("samples-{}", samples_++);
    out_ << "<script type=\"text/plain\" id=\"" << id << "\">" << text << "</script>\n";
    return id;
  }

  /// A sheet for each variant, with its seeds; returns how many cells there was no room for.
  std::size_t add_sheets(const Study& study, const std::vector<TableColumn>& columns, Json& sheets) {
    std::map<std::string, std::vector<const CellRecord*>> of_sheet;
    for (const CellRecord& record : study.results.records) of_sheet[row_group(record)].push_back(&record);
    std::map<std::string, std::size_t> places;
    std::size_t left_out = 0;
    for (const CellRecord& record : study.results.records) {
      if (cells_ >= kMostCells && ++left_out) continue;
      ++cells_;
      const std::string name = row_group(record);
      const auto [at, is_new] = places.try_emplace(name, sheets.size());
      if (is_new) sheets.push_back(sheet_json(study, record, means_json(of_sheet[name], columns)));
      add_cell(record, sheets[at->second]);
    }
    return left_out;
  }

  static Json sheet_json(const Study& study, const CellRecord& record, Json means) {
    Json json = {{"id", study.name + "/" + row_group(record)}, {"name", record.name}};
    json["variant"] = Json::array();
    for (const auto& [title, value] : record.variant)
      if (title != "seed") json["variant"].push_back(title + " " + value);
    json["facts"] = Json::array();
    json["means"] = std::move(means);
    json["seeds"] = Json::array();
    return json;
  }

  /// The cells of a seed's last record, or of a new one.
  static Json& cells_of(const std::string& seed, Json& sheet) {
    Json& seeds = sheet["seeds"];
    if (seeds.empty() || seeds.back()["seed"] != seed)
      seeds.push_back({{"seed", seed}, {"cells", Json::array()}});
    return seeds.back()["cells"];
  }

  void add_cell(const CellRecord& cell, Json& sheet) {
    const fs::path file = cell.folder / "record.json";
    if (cell.kind == "damaged") {
      problems_.push_back(cell.reason);
      const Json record = {{"pipeline", cell.pipeline}, {"status", "failed"}, {"reason", cell.reason}};
      cells_of(seed_of(cell), sheet).push_back(cell_json(record, std::nullopt));
      return;
    }
    try {
      std::ifstream in(file);
      const Json record = Json::parse(in);
      std::optional<Mesh> mesh;
      std::string reason;
      if (cell.reason.empty()) try {
          mesh = read_mesh(cell.folder / "mesh.msh");
        } catch (const InputError& error) {
          problems_.push_back(reason = error.what());
        }
      Json json = cell_json(record, mesh);
      if (mesh) {
        PackedMesh packed = pack_mesh(*mesh, failing_quads(record, *mesh));
        if (take(packed.text.size())) {
          json["mesh"] = add_picture(out_, fmt::format("mesh-{}", pictures_++), std::move(packed));
          in_space_ |= json["mesh"]["dimension"] == 3;
        } else {
          reason = "no room left in this file; see " + (cell.folder / "picture.svg").string();
        }
      }
      if (json.contains("closeups")) used_ += json["closeups"].dump().size();
      if (!reason.empty()) json["no_picture"] = reason;
      if (Json facts = facts_json(record); facts.size() > sheet["facts"].size())
        sheet["facts"] = std::move(facts);
      cells_of(seed_of(cell), sheet).push_back(std::move(json));
    } catch (const Json::exception& error) {
      throw InputError(json_problem(file, "is no record of a cell", error));
    }
  }

  /// Returns the quads beyond the criteria of the case, if it has criteria.
  static std::vector<std::size_t> failing_quads(const Json& record, const Mesh& mesh) {
    std::vector<std::size_t> failing;
    for (const Json& quad : record.value("/criteria/failing_quads"_json_pointer, Json::array()))
      failing.push_back(quad.get<std::size_t>());
    std::erase_if(failing, [&](std::size_t q) { return q >= mesh.quads.size(); });
    return failing;
  }

  const Contents& contents_;
  std::ostream& out_;
  std::size_t used_ = 0, cells_ = 0;
  int pictures_ = 0, samples_ = 0;
  bool in_space_ = false;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> write_report(const fs::path& folder, const fs::path& file) {
  const Contents contents = read_contents(folder);
  std::vector<std::string> problems;
  for (const auto& [name, reason] : contents.left_out) problems.push_back(reason);
  write_file_atomically(file, [&](std::ostream& out) {
    Page page(contents, out);
    page.write();
    problems.insert(problems.end(), page.problems().begin(), page.problems().end());
  });
  return problems;
}

}  // namespace delquad
